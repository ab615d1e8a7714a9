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
}
