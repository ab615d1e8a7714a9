"""Fingers, tools, pinching and pressure in German."""

WORDS = {
    # What touches
    "Finger": "Finger",
    "What touches the surface": "Was die Oberfläche berührt",
    "Point": "Punkt",
    "A needle's tip. The force depends on how finely the body is meshed": (
        "Eine Nadelspitze. Die Kraft hängt davon ab, wie fein der Körper vernetzt ist"
    ),
    "A point's force depends on how finely the body is meshed": (
        "Die Kraft eines Punkts hängt davon ab, wie fein der Körper vernetzt ist"
    ),
    "Fingertip": "Fingerkuppe",
    "A sphere, such as a finger's end": "Eine Kugel wie das Ende eines Fingers",
    "Plate": "Platte",
    "A flat rectangle whose face presses": "Ein flaches Rechteck, dessen Fläche drückt",
    "Rod": "Stab",
    "A cylinder with round ends, lying on the surface": (
        "Ein Zylinder mit runden Enden, der auf der Oberfläche liegt"
    ),
    "Mesh": "Netz",
    "A mesh object of the scene, made convex": "Ein Netzobjekt der Szene, konvex gemacht",
    "Its convex hull presses; the object itself is not changed": (
        "Seine konvexe Hülle drückt; das Objekt selbst bleibt unverändert"
    ),
    "Radius": "Halbmesser",
    "Radius of the fingertip or rod": "Halbmesser der Fingerkuppe oder des Stabs",
    "Length": "Länge",
    "Length of the rod without its round ends": "Länge des Stabs ohne seine runden Enden",
    "Width": "Breite",
    "Width of the plate": "Breite der Platte",
    "Depth": "Tiefe",
    "Depth of the plate, across its width": "Tiefe der Platte, quer zur Breite",
    "Tool": "Werkzeug",
    "Mesh object that presses. Its convex hull is used; it is never changed": (
        "Netzobjekt, das drückt. Seine konvexe Hülle wird benutzt, es selbst nie verändert"
    ),
    "Choose a mesh object of the scene as the tool": (
        "Ein Netzobjekt der Szene als Werkzeug wählen"
    ),
    "Turned": "Gedreht",
    "How the tool is turned": "Wie das Werkzeug gedreht ist",
    "Along Surface": "Wie die Oberfläche",
    "The tool's face lies on the surface where it is set down": (
        "Die Fläche des Werkzeugs liegt auf der Oberfläche, wo es aufgesetzt wird"
    ),
    "Facing View": "Wie die Ansicht",
    "The tool's face looks away from you, into the screen": (
        "Die Fläche des Werkzeugs schaut von dir weg, in den Bildschirm"
    ),
    "As Object": "Wie ein Objekt",
    "The tool is turned as an object of the scene, also an animated one": (
        "Das Werkzeug ist gedreht wie ein Objekt der Szene, auch ein animiertes"
    ),
    "Turned As": "Gedreht wie",
    "Object whose axes the tool has: its face looks along minus Z, a rod lies along X. Without "
    "one, a mesh that presses is turned as it is": (
        "Objekt, dessen Achsen das Werkzeug hat: seine Fläche schaut entlang minus Z, ein Stab "
        "liegt entlang X. Ohne eines ist ein drückendes Netz gedreht, wie es ist"
    ),
    # How contact is computed
    "How the force follows from the depth": "Wie die Kraft aus der Tiefe folgt",
    "Consistent": "Konsistent",
    "The touched point moves exactly as far as the finger, by the least force that does it": (
        "Der berührte Punkt bewegt sich genau so weit wie der Finger, durch die kleinste Kraft, "
        "die das tut"
    ),
    "The touched point moves exactly as far as the finger": (
        "Der berührte Punkt bewegt sich genau so weit wie der Finger"
    ),
    "Paper": "Aufsatz",
    "The paper's (11) to (14): inside triangles the surface stays a little short of the finger": (
        "(11) bis (14) des Aufsatzes: in Dreiecken bleibt die Oberfläche etwas hinter dem Finger"
    ),
    "As in the paper: inside triangles the surface stays a little short": (
        "Wie im Aufsatz: in Dreiecken bleibt die Oberfläche etwas zurück"
    ),
    # Who leads
    "Led By": "Geführt von",
    "An Empty of the scene leads the finger: by keyframes or moved by hand": (
        "Ein Empty der Szene führt den Finger: durch Keyframes oder von Hand bewegt"
    ),
    "Empty whose place is the finger's: by keyframes, constraints or your hand": (
        "Empty, dessen Ort der des Fingers ist: durch Keyframes, Beschränkungen oder deine Hand"
    ),
    "Second Finger": "Zweiter Finger",
    "Who moves a second finger on the same body": (
        "Wer einen zweiten Finger auf demselben Körper bewegt"
    ),
    "One finger presses": "Ein Finger drückt",
    "An Empty of the scene leads a second finger": "Ein Empty der Szene führt einen zweiten Finger",
    "A Haply 2DIY on a serial port of its own; it moves in a plane": (
        "Ein Haply 2DIY an einer eigenen Schnittstelle; er bewegt sich in einer Ebene"
    ),
    "A second haptic device on a serial port": (
        "Ein zweites haptisches Gerät an einer seriellen Schnittstelle"
    ),
    "Empty whose place is the second finger's": "Empty, dessen Ort der des zweiten Fingers ist",
    "Serial port of the second device: a path such as /dev/ttyACM1": (
        "Serielle Schnittstelle des zweiten Geräts: ein Pfad wie /dev/ttyACM1"
    ),
    "Empty that says where the second device's origin and axes are": (
        "Empty, das sagt, wo Ursprung und Achsen des zweiten Geräts sind"
    ),
    "Pinch leads two fingers with the pointer": "Zwicken führt zwei Finger mit dem Zeiger",
    "The body was exchanged under the tool; leave with Escape and press again": (
        "Der Körper unter dem Werkzeug ist ein anderer; mit Escape verlassen, erneut drücken"
    ),
    # Pinch
    "Pinch": "Zwicken",
    "Squeeze the soft object between two fingers: drag each handle, the other stays where it is. "
    "Enter keeps the shape, Escape restores it. From scripts: EXEC_DEFAULT with at_1, by_1, at_2 "
    "and by_2": (
        "Das weiche Objekt zwischen zwei Fingern drücken: jeden Griff ziehen, der andere bleibt, "
        "wo er ist. Enter behält die Form, Escape stellt sie wieder her. Aus Skripten: "
        "EXEC_DEFAULT mit at_1, by_1, at_2 und by_2"
    ),
    "At 2": "Ort 2",
    "By 2": "Weg 2",
    "Where the second finger touches, world coordinates": (
        "Wo der zweite Finger berührt, Weltkoordinaten"
    ),
    "How far the second finger moves, world axes": (
        "Wie weit sich der zweite Finger bewegt, Weltachsen"
    ),
    "Drag each handle inward": "Jeden Griff nach innen ziehen",
    "Held: drag a handle, look around, or keep it": (
        "Gehalten: einen Griff ziehen, umsehen oder behalten"
    ),
    "The Empty leads: move it, or play the animation": (
        "Das Empty führt: bewegen oder die Animation abspielen"
    ),
    # Pressure
    "Pressure": "Druck",
    "Contact Area": "Berührfläche",
    "Largest Pressure": "Größter Druck",
    "Show Pressure": "Druck zeigen",
    "Draw where the tool touches, coloured by pressure": (
        "Zeichnen, wo das Werkzeug berührt, nach Druck gefärbt"
    ),
    # Along an animation
    "Press Along Animation": "Animation entlang drücken",
    "Let the animated tool press through the frames of the scene, and keep every frame's shape as "
    "a shape key that plays by itself. Escape is not heeded meanwhile; undo takes it back": (
        "Das animierte Werkzeug durch die Bilder der Szene drücken lassen und die Form jedes Bilds "
        "als Formschlüssel behalten, der von selbst abspielt. Escape wirkt währenddessen nicht; "
        "Rückgängig nimmt es zurück"
    ),
    "First Frame": "Erstes Bild",
    "Where it begins; -1 is the scene's first": "Wo es beginnt; -1 ist das erste der Szene",
    "Last Frame": "Letztes Bild",
    "Where it ends; -1 is the scene's last": "Wo es endet; -1 ist das letzte der Szene",
    "Step": "Schrittweite",
    "Keep every so many frames; the shape goes straight between them": (
        "Jedes so vielte Bild behalten; dazwischen geht die Form geradlinig"
    ),
    "This Frame Only": "Nur dieses Bild",
    "Press up to the current frame and keep only its shape": (
        "Bis zum aktuellen Bild drücken und nur dessen Form behalten"
    ),
}
