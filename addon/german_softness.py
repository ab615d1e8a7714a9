"""Softness in the maker's words, in German."""

WORDS = {
    "Shore 00": "Shore 00",
    "Shore A": "Shore A",
    "Softer than this scale tells": "Weicher, als diese Skala angibt",
    "Firmer than this scale tells": "Fester, als diese Skala angibt",
    "Soft polyurethane foam": "Weicher Polyurethanschaum",
    "Latex foam": "Latexschaum",
    "EVA foam (Shore A 30)": "EVA-Schaum (Shore A 30)",
    "Gelatine 3 %": "Gelatine 3 %",
    "Gelatine 5 %": "Gelatine 5 %",
    "Ballistic gel 10 %": "Ballistische Gelatine 10 %",
    "Firm toy stuffing": "Feste Stofftierfüllung",
    "Skin over flesh": "Haut über Fleisch",
    "Scale": "Skala",
    "Shore": "Shore",
    "Which durometer the Shore value is of": "Von welchem Durometer der Shore-Wert stammt",
    "For gels, soft silicones and foams: a ball on a light spring": (
        "Für Gele, weiche Silikone und Schäume: eine Kugel an einer leichten Feder"
    ),
    "For rubbers: a blunt cone on a stronger spring": (
        "Für Gummi: ein stumpfer Kegel an einer stärkeren Feder"
    ),
    "Softness as data sheets tell it, from 10 to 90: what a durometer reads on a thick "
    "block. Sets Young's modulus, and follows it": (
        "Weichheit wie in Datenblättern, von 10 bis 90: was ein Durometer auf einem dicken "
        "Block anzeigt. Setzt den Elastizitätsmodul und folgt ihm"
    ),
    "Softness": "Weichheit",
    "Measured At": "Gemessen an",
    "3D Cursor": "3D-Cursor",
    "Where durometer and curve press, unless you click a place": (
        "Wo Durometer und Kurve drücken, wenn keine Stelle angeklickt wird"
    ),
    "Selected Vertices": "Ausgewählte Vertices",
    "The surface point nearest to the 3D cursor": (
        "Die Stelle der Oberfläche, die dem 3D-Cursor am nächsten liegt"
    ),
    "The surface point nearest to the middle of the vertices selected in Edit Mode": (
        "Die Stelle der Oberfläche, die der Mitte der im Bearbeitungsmodus ausgewählten "
        "Vertices am nächsten liegt"
    ),
    "Pick": "Anklicken",
    "Click the place in the view": "Die Stelle in der Ansicht anklicken",
    "Click the place on the object; right click to leave": (
        "Stelle auf dem Objekt anklicken; Rechtsklick bricht ab"
    ),
    "Reading": "Anzeige",
    "On a Thick Block": "Auf einem dicken Block",
    "Text Block": "Textblock",
    "Stiffness": "Steifigkeit",
    "Force": "Kraft",
    "Depth": "Tiefe",
    "Place": "Stelle",
    "Colour": "Farbe",
    "A colour of the map": "Eine Farbe der Karte",
    "Fingertip Radius": "Radius der Fingerspitze",
    "How large what presses is, for curve and map; 0 for a point": (
        "Wie groß ist, was drückt, für Kurve und Karte; 0 für einen Punkt"
    ),
    "Read Durometer": "Durometer ablesen",
    "Press the indenter of the chosen scale into the object, and read what the device would "
    "show there": (
        "Den Eindringkörper der gewählten Skala in das Objekt drücken und ablesen, was das "
        "Gerät dort anzeigen würde"
    ),
    "Force Curve": "Kraftkurve",
    "Press straight in, deeper and deeper, and write force against depth into a text block": (
        "Gerade hineindrücken, immer tiefer, und die Kraft über der Tiefe in einen Textblock "
        "schreiben"
    ),
    "How far to press; 0 for as far as is small there": (
        "Wie weit gedrückt wird; 0 für so weit, wie es dort klein ist"
    ),
    "The surface point nearest to this is asked, world coordinates. Without one, the "
    "panel's Measured At says where": (
        "Gefragt wird die nächste Stelle der Oberfläche, Weltkoordinaten. Ohne Angabe gilt "
        "„Gemessen an“"
    ),
    "Map Softness": "Weichheit kartieren",
    "Colour the object by how hard a fingertip must push for each millimetre: dark is "
    "soft, yellow is firm. Writes the colour attribute Palpate Softness and shows it in "
    "the view": (
        "Das Objekt danach färben, wie stark eine Fingerspitze für jeden Millimeter drücken "
        "muss: dunkel ist weich, gelb ist fest. Schreibt das Farbattribut „Palpate Softness“ "
        "und zeigt es in der Ansicht"
    ),
    "Remove Softness Map": "Weichheitskarte entfernen",
    "Delete the colour attribute Palpate Softness": "Das Farbattribut „Palpate Softness“ löschen",
    "Viewport Shading, Color, Attribute shows it": (
        "Zu sehen mit Viewport-Schattierung, Farbe, Attribut"
    ),
}
