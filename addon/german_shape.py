"""Shapes of large deformation and the felt force in German."""

WORDS = {
    "Large Deformation": "Große Verformung",
    "Shape": "Form",
    "How the deformed shape is computed. Can be changed while you press": (
        "Wie die verformte Gestalt berechnet wird. Während des Drückens umschaltbar"
    ),
    "As the force is computed; large bends look swollen": (
        "Wie die Kraft berechnet wird; große Biegungen sehen aufgebläht aus"
    ),
    "Table (Paper)": "Tabelle (Artikel)",
    "The paper's (16): stored large deformations, solved exactly; takes long to compute": (
        "Gleichung (16) des Artikels: gespeicherte große Verformungen, genau gelöst; "
        "braucht lange zum Berechnen"
    ),
    "Series": "Reihe",
    "Power series in the force: right for bends and moderate dents, in milliseconds": (
        "Potenzreihe in der Kraft: richtig für Biegungen und mäßige Dellen, in Millisekunden"
    ),
    "Rotation-Strain": "Drehung und Dehnung",
    "Bends and twists keep their size; nearest to the truth, without a table": (
        "Gebogenes und Verdrehtes behält seine Größe; der Wahrheit am nächsten, ohne Tabelle"
    ),
    "Felt Force": "Gefühlte Kraft",
    "How the force follows from large depths": "Wie die Kraft aus großen Tiefen folgt",
    "The paper's: in proportion to the depth, however deep": (
        "Die des Artikels: im Verhältnis zur Tiefe, wie tief auch immer"
    ),
    "Corrected": "Berichtigt",
    "As a solid of large deformation: softer where it is pressed in far": (
        "Wie ein Körper großer Verformung: weicher, wo er weit eingedrückt ist"
    ),
    "Felt force {share} %": "Gefühlte Kraft {share} %",
    "It is kept as far as it was computed, {share} %": (
        "Sie ist so behalten, wie weit sie berechnet war, {share} %"
    ),
    "Linear where two fingers hold a slender part": (
        "Linear, wo zwei Finger einen schlanken Teil halten"
    ),
    "Tools feel the linear force": "Werkzeuge fühlen die lineare Kraft",
    "The linear force is felt": "Gefühlt wird die lineare Kraft",
    "Found around the touched place first, and kept": (
        "Wird zuerst um die berührte Stelle ermittelt und behalten"
    ),
    "Whole Surface, About": "Ganze Oberfläche, etwa",
    "The linear shape is drawn": "Gezeichnet wird die lineare Form",
    "Shape {share} %": "Form {share} %",
    "A Frame, About": "Ein Bild, etwa",
    "First Touch, About": "Erste Berührung, etwa",
    "Whole Table, About": "Ganze Tabelle, etwa",
    "Memory, About": "Speicher, etwa",
    "Too large a body to be drawn 60 times a second this way": (
        "Der Körper ist zu groß, um so 60-mal in der Sekunde gezeichnet zu werden"
    ),
    "Computed around the touched place first, and kept": (
        "Wird zuerst um die berührte Stelle berechnet und behalten"
    ),
}
