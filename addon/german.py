"""The interface in German."""

from .german_finger import WORDS as FINGER_WORDS
from .german_force import WORDS as FORCE_WORDS
from .german_shape import WORDS as SHAPE_WORDS
from .german_softness import WORDS as SOFTNESS_WORDS

WORDS = {
    **FORCE_WORDS,
    **SOFTNESS_WORDS,
    **FINGER_WORDS,
    **SHAPE_WORDS,
    # Panel
    "Pins": "Fixierung",
    "Device": "Gerät",
    "Bake": "Berechnung",
    "Make Soft": "Weich machen",
    "Make Soft Again": "Neu weich machen",
    "Rebuild Body": "Körper neu berechnen",
    "Press": "Drücken",
    "Cancel": "Abbrechen",
    "Make Pin Group": "Fixiergruppe anlegen",
    "Refresh Devices": "Geräte neu suchen",
    "Remove Softness": "Weichheit entfernen",
    "Choose a material and pins, then press Make Soft": (
        "Material und Fixierung wählen, dann „Weich machen“ drücken"
    ),
    "Ready to press": "Bereit zum Drücken",
    "The body file is missing; Press computes it again": (
        "Die Körperdatei fehlt; „Drücken“ berechnet sie neu"
    ),
    "Press Make Soft Again": "„Neu weich machen“ drücken",
    "The body file is missing; press Rebuild Body": (
        "Die Körperdatei fehlt; „Körper neu berechnen“ drücken"
    ),
    "The body file is damaged; press Rebuild Body": (
        "Die Körperdatei ist beschädigt; „Körper neu berechnen“ drücken"
    ),
    "The faces are connected differently than when it was baked": (
        "Die Flächen hängen anders zusammen als bei der Berechnung"
    ),
    "The object's scale or the scene's unit scale changed since the bake": (
        "Skalierung des Objekts oder Einheit der Szene hat sich seit der Berechnung geändert"
    ),
    "The shape was edited since the bake": "Die Form wurde seit der Berechnung bearbeitet",
    "Enter keeps the shape, Escape restores it": (
        "Eingabe behält die Form, Escape stellt sie wieder her"
    ),
    "There is no such vertex group": "Diese Punktgruppe gibt es nicht",
    "Only the base mesh is baked: apply the Mirror modifier first": (
        "Nur das Grundnetz wird berechnet: zuerst den Spiegeln-Modifikator anwenden"
    ),
    "Nodes": "Knoten",
    "Tetrahedra": "Tetraeder",
    "Free Surface Nodes": "Freie Knoten",
    "Memory": "Speicher",
    "Bake Time": "Backzeit",
    "Young's (Pa)": "E-Modul (Pa)",
    "Select a mesh object": "Ein Netzobjekt auswählen",
    "Update Pins": "Fixierung übernehmen",
    "Fit Memory": "An den Speicher anpassen",
    "Compress It": "Komprimieren",
    "Use Edge Length {length}": "Kantenlänge {length} nehmen",
    "{time} left": "noch {time}",
    "About {nodes} nodes in {time}": "Etwa {nodes} Knoten in {time}",
    "Takes {needed} of memory; {available} are free": (
        "Braucht {needed} Speicher; {available} sind frei"
    ),
    "The Next Bake, About": "Nächste Berechnung, etwa",
    "Peak Memory": "Größter Speicher",
    "File": "Datei",
    "Uncompressed": "Unkomprimiert",
    "Stiff Region": "Steifer Bereich",
    "Method": "Methode",
    "Baked Body": "Berechneter Körper",
    "Bone in flesh: a closed shell inside the mesh, as a vertex group": (
        "Knochen im Fleisch: eine geschlossene Hülle im Netz, als Punktgruppe"
    ),
    "Linear: as in the paper, right up to about 0.4": (
        "Linear: wie im Aufsatz, richtig bis etwa 0,4"
    ),
    "Smoothed: does not lock near 0.5": "Geglättet: versteift nicht nahe 0,5",
    "These pins were computed before: no bake needed": (
        "Diese Fixierung wurde schon berechnet: keine Berechnung nötig"
    ),
    "More is pinned: takes effect in about {time}, no bake needed": (
        "Mehr ist fixiert: wirkt in etwa {time}, ohne Berechnung"
    ),
    "Less is pinned than before: needs a bake": (
        "Weniger ist fixiert als vorher: braucht eine Berechnung"
    ),
    "The pins changed and need a bake": "Die Fixierung ist anders und braucht eine Berechnung",
    "Press does it by itself, too": "„Drücken“ tut es auch von selbst",
    "These pins would hold the whole surface; pin less": (
        "So wäre die ganze Oberfläche fixiert; weniger fixieren"
    ),
    "Changed since the bake: {names}": "Seit der Berechnung geändert: {names}",
    "Rebuild Body takes it over": "„Körper neu berechnen“ übernimmt das",
    "Make Soft Again takes it over": "„Neu weich machen“ übernimmt das",
    # A bake
    "The body is ready; leave Edit Mode to receive it": (
        "Der Körper ist fertig; zum Übernehmen den Bearbeitungsmodus verlassen"
    ),
    "Starting": "Beginnt",
    "Filling with tetrahedra": "Füllt mit Tetraedern",
    "Comparing with the mesh": "Vergleicht mit dem Netz",
    "Assembling the stiffness": "Stellt die Steifigkeit auf",
    "Inverting the stiffness": "Kehrt die Steifigkeit um",
    "reading the mesh": "liest das Netz",
    "simplifying the surface": "vereinfacht die Oberfläche",
    "inserting the surface": "fügt die Oberfläche ein",
    "improving tetrahedra": "verbessert Tetraeder",
    "finishing": "schließt ab",
    "Compressing the compliance": "Komprimiert die Nachgiebigkeit",
    "Planning the elimination": "Plant die Elimination",
    "Writing the body file": "Schreibt die Körperdatei",
    # View
    "Press on the surface and drag": "Auf die Oberfläche drücken und ziehen",
    "Pressing": "Drücken",
    "Above the surface: drag inward, or turn the wheel": (
        "Über der Oberfläche: nach innen ziehen oder am Rad drehen"
    ),
    "Held: look around, keep it, or press elsewhere": (
        "Gehalten: umsehen, behalten oder anderswo drücken"
    ),
    "Esc  Leave": "Esc  Verlassen",
    "Wheel  Deeper": "Rad  Tiefer",
    "Enter  Keep shape      Esc  Restore": "Eingabe  Form behalten      Esc  Wiederherstellen",
    "Nothing is pressed yet, so there is no shape to keep": (
        "Noch ist nichts eingedrückt, also gibt es keine Form zu behalten"
    ),
    # Properties
    "A usual soft material, as a start": "Ein übliches weiches Material als Anfang",
    "Plush toy": "Plüschtier",
    "Jelly": "Gelee",
    "Paper's soft cube": "Weicher Würfel des Aufsatzes",
    "Upholstery foam": "Polsterschaum",
    "Soft silicone (Shore 00-30)": "Weiches Silikon (Shore 00-30)",
    "Firm silicone (Shore A 20)": "Festes Silikon (Shore A 20)",
    "Rubber (Shore A 50)": "Gummi (Shore A 50)",
    "Custom": "Benutzerdefiniert",
    "Young's modulus and Poisson's ratio as set below": (
        "Elastizitätsmodul und Querkontraktionszahl wie unten eingestellt"
    ),
    "Young's Modulus": "Elastizitätsmodul",
    "Stiffness in pascal. Takes effect at once, without a new bake": (
        "Steifigkeit in Pascal. Wirkt sofort, ohne neue Berechnung"
    ),
    "Poisson's Ratio": "Querkontraktion",
    "How much it bulges sideways: 0 like cork, near 0.5 like rubber or water. Needs Rebuild Body": (
        "Wie stark es seitlich ausweicht: 0 wie Kork, nahe 0,5 wie Gummi oder Wasser. "
        "Braucht „Körper neu berechnen“"
    ),
    "Pin": "Fixieren",
    "Which part never moves": "Welcher Teil sich nie bewegt",
    "Below Height": "Unter Höhe",
    "Everything in the lowest part of the object, as it stands": (
        "Alles im untersten Teil des Objekts, wie es steht"
    ),
    "Vertices with a weight of 0.5 or more": "Vertices mit einem Gewicht ab 0,5",
    "Share of the object's height in world Z below which it is pinned": (
        "Anteil der Höhe in Welt-Z, unter dem das Objekt fixiert ist"
    ),
    "Share of the object's height in world Z below which vertices are pinned": (
        "Anteil der Höhe in Welt-Z, unter dem Vertices fixiert sind"
    ),
    "Vertex group that is pinned": "Punktgruppe, die fixiert ist",
    "Edge Length": "Kantenlänge",
    "Wanted edge length of the tetrahedra, as a share of the object's diagonal. "
    "Half the length: about eight times the nodes": (
        "Gewünschte Kantenlänge der Tetraeder als Anteil der Diagonale. "
        "Halbe Länge: etwa achtmal so viele Knoten"
    ),
    "Tolerance": "Toleranz",
    "How far the body may stray from the mesh, as a share of the diagonal. Smaller takes longer": (
        "Wie weit der Körper vom Netz abweichen darf, als Anteil der Diagonale. "
        "Kleiner dauert länger"
    ),
    "Simplify Above": "Dreiecke bis",
    "Denser meshes are simplified to this many triangles before the bake. "
    "What you see stays as dense as it is": (
        "Dichtere Netze werden vorher auf so viele Dreiecke vereinfacht. "
        "Das Sichtbare bleibt, wie es ist"
    ),
    "Time Limit": "Zeitlimit",
    "Give up filling with tetrahedra after this many seconds": (
        "Das Füllen mit Tetraedern nach so vielen Sekunden aufgeben"
    ),
    "Press With": "Drücken mit",
    "Who moves the probe": "Wer den Taster bewegt",
    "Pointer": "Zeiger",
    "Mouse, pen or trackpad press on the surface": "Maus, Stift oder Trackpad drücken",
    "Simulated Device": "Simuliertes Gerät",
    "A program that behaves like a haptic device": "Ein Programm, das ein Gerät nachahmt",
    "Serial Device": "Serielles Gerät",
    "A haptic device on a serial port": "Ein haptisches Gerät an einer seriellen Schnittstelle",
    "Serial port of the device: one from the list, or a path typed in": (
        "Schnittstelle des Geräts: aus der Liste oder als Pfad eingegeben"
    ),
    "Device Frame": "Gerätelage",
    "Empty that says where the device's origin and axes are. Without one they are the object's": (
        "Empty, das Ursprung und Achsen des Geräts angibt. Ohne sind es die des Objekts"
    ),
    "Motion Scale": "Wegfaktor",
    "How far the probe moves per movement of the device": (
        "Wie weit sich der Taster je Bewegung des Geräts bewegt"
    ),
    "Automatic": "Automatisch",
    "Smoothed where linear tetrahedra would be too stiff, linear elsewhere": (
        "Geglättet, wo lineare Tetraeder zu steif wären, sonst linear"
    ),
    "Linear": "Linear",
    "The paper's. Too stiff as Poisson's ratio comes near 0.5": (
        "Die des Aufsatzes. Zu steif, wenn die Querkontraktion nahe 0,5 ist"
    ),
    "Smoothed": "Geglättet",
    "Right for rubber and silicone too. The bake takes longer": (
        "Auch für Gummi und Silikon richtig. Die Berechnung dauert länger"
    ),
    "Full while it is small, compressed where it would be large": (
        "Voll, solange sie klein ist, komprimiert, wo sie groß würde"
    ),
    "Full": "Voll",
    "Every number is kept. Memory grows with the square of the surface": (
        "Jede Zahl bleibt. Der Speicher wächst mit dem Quadrat der Oberfläche"
    ),
    "Compressed": "Komprimiert",
    "Takes a tenth of the memory or less, for large bodies": (
        "Braucht ein Zehntel des Speichers oder weniger, für große Körper"
    ),
    "Vertex group that is stiffer or softer than the material. A closed shell inside the mesh "
    "makes all that it encloses stiff: bone in flesh. Needs Rebuild Body": (
        "Punktgruppe, die steifer oder weicher ist als das Material. Eine geschlossene Hülle "
        "im Netz macht alles steif, was sie umschließt: Knochen im Fleisch. Braucht „Körper "
        "neu berechnen“"
    ),
    "Times as Stiff": "Mal so steif",
    "Factor on Young's modulus where the group's weight is 1; halfway painted weights feel "
    "halfway": (
        "Faktor auf den Elastizitätsmodul, wo das Gewicht der Gruppe 1 ist; halb gemalt fühlt "
        "sich halb an"
    ),
    "Formulation": "Formulierung",
    "How tetrahedra resist. Needs Rebuild Body": (
        "Wie Tetraeder widerstehen. Braucht „Körper neu berechnen“"
    ),
    "Compliance": "Nachgiebigkeit",
    "How the computed response is kept. Needs Rebuild Body": (
        "Wie die berechnete Antwort gespeichert wird. Braucht „Körper neu berechnen“"
    ),
    "Largest Error": "Größter Fehler",
    "By how much compressing may change the shape under any touch. The force that is felt "
    "stays exact": (
        "Wie weit das Komprimieren die Form bei einer Berührung ändern darf. Die gefühlte "
        "Kraft bleibt exakt"
    ),
    # Preferences
    "What new files press with": "Womit in neuen Dateien gedrückt wird",
    "Largest Force": "Größte Kraft",
    "A device never gives more than this, in newtons, nor more than it says itself": (
        "Mehr gibt ein Gerät nie, in Newton, und nie mehr als es selbst angibt"
    ),
    "Pointer Sensitivity": "Empfindlichkeit",
    "How deep a drag presses: 1 follows the pointer": (
        "Wie tief das Ziehen drückt: 1 folgt dem Zeiger"
    ),
    "Body Folder": "Körperordner",
    "Where bodies of files not yet saved are kept. Empty: the extension's own user folder": (
        "Wo Körper ungespeicherter Dateien liegen. Leer: der eigene Ordner der Erweiterung"
    ),
    "Probe": "Taster",
    "Contact": "Berührung",
    "Force": "Kraft",
    "Probe Size": "Tastergröße",
    "Radius of the probe on the screen": "Halbmesser des Tasters auf dem Bildschirm",
    "Arrow Length": "Pfeillänge",
    "Length of the arrow for large forces; half of it at 0.3 N": (
        "Länge des Pfeils bei großen Kräften; die Hälfte bei 0,3 N"
    ),
    "Files": "Dateien",
    "In the View": "In der Ansicht",
    # Operators
    "Stop the bake; nothing is changed and nothing is left": (
        "Die Berechnung beenden; nichts wird geändert, nichts bleibt zurück"
    ),
    "Fill the mesh with tetrahedra and compute how it gives way; "
    "the mesh itself stays as it is. Escape cancels": (
        "Das Netz mit Tetraedern füllen und berechnen, wie es nachgibt; "
        "das Netz selbst bleibt. Escape bricht ab"
    ),
    "Put all vertices below this share of the object's height, as it stands now, "
    "into the vertex group Pinned": (
        "Alle Vertices unter diesem Anteil der Höhe, wie es jetzt steht, "
        "in die Punktgruppe Pinned aufnehmen"
    ),
    "Press the soft object with the pointer or a device. Enter keeps the shape, "
    "Escape restores it. From scripts: EXEC_DEFAULT with at and by": (
        "Das weiche Objekt mit Zeiger oder Gerät drücken. Eingabe behält die Form, "
        "Escape stellt sie wieder her. Aus Skripten: EXEC_DEFAULT mit at und by"
    ),
    "At": "Ort",
    "The surface point nearest to this is touched, world coordinates": (
        "Der nächste Oberflächenpunkt wird berührt, Weltkoordinaten"
    ),
    "By": "Weg",
    "How far it is moved, world axes": "Wie weit er bewegt wird, Weltachsen",
    "Keep": "Behalten",
    "Keep the shape as a shape key": "Die Form als Formschlüssel behalten",
    "Compute the body again from the tetrahedra stored in this file, with the pins and "
    "the material set now. Also for a body file that is missing or damaged": (
        "Den Körper aus den Tetraedern dieser Datei neu berechnen, mit jetziger Fixierung "
        "und jetzigem Material. Auch für eine fehlende oder beschädigte Körperdatei"
    ),
    "Look for serial ports again": "Erneut nach Schnittstellen suchen",
    "Delete the body and its file. Mesh, pins and kept shapes stay": (
        "Körper und Datei löschen. Netz, Fixierung und behaltene Formen bleiben"
    ),
    "Hold the body where the pins are now. More pins take about a second and no bake; so do "
    "pins that were baked before": (
        "Den Körper dort halten, wo jetzt fixiert ist. Mehr Fixierung braucht etwa eine "
        "Sekunde und keine Berechnung, früher berechnete ebenso"
    ),
    "Change the bake's settings so that the memory of this machine suffices": (
        "Die Einstellungen so ändern, dass der Speicher dieses Rechners reicht"
    ),
    "What is changed": "Was geändert wird",
    "Keep the computed response compressed": "Die berechnete Antwort komprimiert speichern",
    "Coarser": "Gröber",
    "Take the smallest edge length that fits": "Die kleinste passende Kantenlänge nehmen",
}
