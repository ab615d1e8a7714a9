"""Force, its loop, and recordings in German."""

WORDS = {
    # The servo's states
    "Waiting": "Wartet",
    "Free": "Frei",
    "Touching": "Berührt",
    "Force Rises": "Kraft kommt",
    "Fault": "Fehler",
    "Force Off": "Kraft aus",
    "Force On": "Kraft ein",
    "Stopped": "Beendet",
    "No force yet: the device is not ready": "Noch keine Kraft: das Gerät ist nicht bereit",
    "Force comes as soon as the surface is touched": (
        "Kraft kommt, sobald die Oberfläche berührt wird"
    ),
    "The force rises slowly": "Die Kraft steigt langsam",
    "No force until the fault is gone": "Keine Kraft, bis der Fehler behoben ist",
    "No force until it is switched on": "Keine Kraft, bis sie eingeschaltet wird",
    "The force loop does not run": "Die Kraftschleife läuft nicht",
    # Reasons
    "The device answers but tells no position yet; plug it in again if it stays so": (
        "Das Gerät antwortet, meldet aber noch keine Position; neu anstecken, falls es so bleibt"
    ),
    "The device is not ready: calibrate it or switch on its motors": (
        "Das Gerät ist nicht bereit: kalibrieren oder seine Motoren einschalten"
    ),
    "The force is switched off; Space or Force On brings it back": (
        "Die Kraft ist aus; Leertaste oder „Kraft ein“ bringt sie zurück"
    ),
    "A button of the device is held; let it go and the force comes back": (
        "Eine Taste des Geräts ist gedrückt; loslassen, dann kommt die Kraft zurück"
    ),
    "The device is ready; the force rises slowly": (
        "Das Gerät ist bereit; die Kraft steigt langsam"
    ),
    "Switched on; the force rises slowly": "Eingeschaltet; die Kraft steigt langsam",
    "The button was let go; the force rises slowly": (
        "Die Taste wurde losgelassen; die Kraft steigt langsam"
    ),
    "The body is another one now; the force rises slowly": (
        "Der Körper ist jetzt ein anderer; die Kraft steigt langsam"
    ),
    "The probe is inside the body: lead it out, then touch from outside": (
        "Der Taster ist im Körper: herausführen und von außen berühren"
    ),
    "The force loop has not started yet": "Die Kraftschleife läuft noch nicht",
    "Pressing has ended": "Das Drücken ist beendet",
    "The fault is gone; the force rises slowly": (
        "Der Fehler ist behoben; die Kraft steigt langsam"
    ),
    "The board is being set up; leave the handle where it is": (
        "Die Platine wird eingerichtet; den Griff liegen lassen"
    ),
    "The board lost track of its handle: leave, put it in its rest pose, and press again": (
        "Die Platine weiß nicht mehr, wo der Griff ist: verlassen, ihn in die Ruhelage bringen, "
        "erneut drücken"
    ),
    "The arms are stretched; bring the handle back to the middle": (
        "Die Arme sind gestreckt; den Griff zurück zur Mitte bringen"
    ),
    # Limits
    "Held back: the force rises slowly": "Zurückgehalten: die Kraft steigt langsam",
    "Held back: the largest force is reached": "Zurückgehalten: die größte Kraft ist erreicht",
    "Held back: the force changes too fast": "Zurückgehalten: die Kraft ändert sich zu schnell",
    # Faults
    "Waiting for the device: check its port, cable and power": (
        "Warte auf das Gerät: Anschluss, Kabel und Strom prüfen"
    ),
    "The device is unplugged; plug it in again and pressing goes on": (
        "Das Gerät ist abgezogen; wieder anstecken, dann geht es weiter"
    ),
    "The device is silent; check its cable and power, pressing goes on when it speaks": (
        "Das Gerät schweigt; Kabel und Strom prüfen, es geht weiter, sobald es antwortet"
    ),
    "The device moved too fast and was let go; hold still and pressing goes on": (
        "Das Gerät war zu schnell und wurde losgelassen; stillhalten, dann geht es weiter"
    ),
    "The device sent a position that is no number; pressing goes on when it recovers": (
        "Das Gerät meldete eine ungültige Position; es geht weiter, sobald es sich erholt"
    ),
    "The device speaks another version of the link; update its firmware": (
        "Das Gerät spricht eine andere Protokollversion; seine Firmware aktualisieren"
    ),
    "The device reports a fault of its own; see its manual, or plug it in again": (
        "Das Gerät meldet einen eigenen Fehler; siehe Handbuch, oder neu anstecken"
    ),
    "The computer stood still for a moment, so the device was let go; pressing goes on by itself": (
        "Der Rechner stand kurz still, darum wurde das Gerät losgelassen; es geht von selbst weiter"
    ),
    "The force loop has failed, so pressing has ended; press again": (
        "Die Kraftschleife ist ausgefallen, das Drücken ist beendet; erneut drücken"
    ),
    "Faults": "Fehler",
    "Unplugged": "Abgezogen",
    "Silent": "Schweigt",
    "Too Fast": "Zu schnell",
    "Invalid Number": "Ungültige Zahl",
    "Other Version": "Andere Version",
    "Fault of the Device": "Gerätefehler",
    "Stood Still": "Stillstand",
    "Force Loop Failed": "Schleife ausgefallen",
    # Switching it
    "Let the device go limp at once, or let its force rise again slowly. Space does it too": (
        "Das Gerät sofort kraftlos machen oder die Kraft langsam wiederkommen lassen. "
        "Die Leertaste tut es auch"
    ),
    "The device gives": "Das Gerät gibt",
    "Space  Force Off": "Leertaste  Kraft aus",
    "Space  Force On": "Leertaste  Kraft ein",
    # Touch
    "Touch": "Berührung",
    "Smooth Facets": "Facetten glätten",
    "Feel the smooth surface that the facets stand for, instead of their edges": (
        "Die glatte Fläche fühlen, für die die Facetten stehen, statt ihrer Kanten"
    ),
    "Static Friction": "Haftreibung",
    "How well the surface holds a resting finger: sideways force over pressing force. "
    "0 is slippery, felt is about 0.5, rubber 1": (
        "Wie gut die Oberfläche einen ruhenden Finger hält: Seitenkraft durch Andruck. "
        "0 ist glitschig, Filz etwa 0,5, Gummi 1"
    ),
    "Sliding": "Gleitreibung",
    "Dynamic Friction": "Gleitreibung",
    "The same while the finger slides; never more than the static one": (
        "Dasselbe, während der Finger gleitet; nie mehr als die Haftreibung"
    ),
    # Force loop
    "Force Loop": "Kraftschleife",
    "Rate": "Rate",
    "How often a second the force is computed, in hertz. Firmer bodies want more, "
    "slow devices and computers less": (
        "Wie oft je Sekunde die Kraft berechnet wird, in Hertz. Festere Körper wollen mehr, "
        "langsame Geräte und Rechner weniger"
    ),
    "While you press, its figures appear here": "Beim Drücken erscheinen hier ihre Zahlen",
    "Ticks": "Schritte",
    "Late by 0.2 ms": "0,2 ms zu spät",
    "Late by 1 ms": "1 ms zu spät",
    "Longest Gap": "Längste Lücke",
    "Priority": "Priorität",
    "No real-time priority: {reason}": "Keine Echtzeitpriorität: {reason}",
    "Time in a Tick: Mean, 99 %": "Zeit je Schritt: Mittel, 99 %",
    "Read": "Lesen",
    "Proxy": "Stellvertreter",
    "Write": "Schreiben",
    "Connection": "Verbindung",
    "Received": "Empfangen",
    "Sent": "Gesendet",
    "Lost": "Verloren",
    "Damaged": "Beschädigt",
    "Out of Order": "Außer der Reihe",
    "Not Sent": "Nicht gesendet",
    "Opened Again": "Neu geöffnet",
    "Stable Contact": "Stabile Berührung",
    "Let the motors feel no contact that is too stiff for them and your hand to hold without "
    "shaking. The shape stays as it is": (
        "Die Motoren keine Berührung fühlen lassen, die für sie und deine Hand zu steif ist, um "
        "ruhig zu bleiben. Die Form bleibt, wie sie ist"
    ),
    "Own Values": "Eigene Werte",
    "Choose yourself what keeps the contact stable, for a device that you know": (
        "Selbst wählen, was die Berührung stabil hält, für ein bekanntes Gerät"
    ),
    "Largest Stiffness": "Größte Steifigkeit",
    "The stiffest contact that the motors feel, in newtons per metre": (
        "Die steifste Berührung, die die Motoren fühlen, in Newton je Meter"
    ),
    "Stiffness": "Steifigkeit",
    "Damping": "Dämpfung",
    "What brakes the device in a contact of that stiffness, in newton seconds per metre; "
    "softer contacts get their share": (
        "Was das Gerät in einer so steifen Berührung bremst, in Newtonsekunden je Meter; "
        "weichere bekommen ihren Anteil"
    ),
    "Passivity Control": "Passivitätsregelung",
    "Watch the energy that the motors give, and brake away what no soft body could have stored": (
        "Die Energie der Motoren beobachten und wegbremsen, was kein weicher Körper gespeichert "
        "haben kann"
    ),
    # Devices
    "Haply 2DIY": "Haply 2DIY",
    "A Haply 2DIY on its serial port; it moves in a plane": (
        "Ein Haply 2DIY an seiner Schnittstelle; er bewegt sich in einer Ebene"
    ),
    "Kind": "Art",
    "Which device is simulated": "Welches Gerät simuliert wird",
    "Three Axes": "Drei Achsen",
    "A device that speaks Palpate's serial link": (
        "Ein Gerät, das Palpates serielles Protokoll spricht"
    ),
    "A Haply 2DIY with its board; it moves in a plane": (
        "Ein Haply 2DIY mit seiner Platine; er bewegt sich in einer Ebene"
    ),
    "Model": "Modell",
    "Which of the 2DIYs it is": "Welcher der 2DIYs es ist",
    "Motors side by side, the newest boards": "Motoren nebeneinander, neueste Platinen",
    "Motors side by side, earlier boards": "Motoren nebeneinander, frühere Platinen",
    "Motors on one axis": "Motoren auf einer Achse",
    "Dev Kit": "Entwicklersatz",
    "The small early kit": "Der kleine frühe Bausatz",
    "Handle at Rest": "Griff in Ruhelage",
    "The handle lies in its rest pose now: let the board count its angles from there anew, "
    "also if it was in use before": (
        "Der Griff liegt jetzt in seiner Ruhelage: die Platine von dort neu zählen lassen, auch "
        "wenn sie schon in Gebrauch war"
    ),
    "Before Press, put the handle in its rest pose and leave it there": (
        "Vor dem Drücken den Griff in die Ruhelage bringen und dort lassen"
    ),
    "Show Workspace": "Arbeitsraum zeigen",
    "Draw in the view where the device reaches": "In der Ansicht zeichnen, wohin das Gerät reicht",
    # Recording
    "Recording": "Aufzeichnung",
    "Record": "Aufzeichnen",
    "Stop Recording": "Aufzeichnung beenden",
    "Record every tick of the force loop: time, probe, contact, forces and state. A new "
    "recording replaces the one before": (
        "Jeden Schritt der Kraftschleife aufzeichnen: Zeit, Taster, Berührung, Kräfte und Zustand. "
        "Eine neue Aufzeichnung ersetzt die vorige"
    ),
    "Save Recording...": "Aufzeichnung speichern...",
    "Write the recorded ticks to a file, also while pressing goes on": (
        "Die aufgezeichneten Schritte in eine Datei schreiben, auch während des Drückens"
    ),
    "How the file is written": "Wie die Datei geschrieben wird",
    "A table for spreadsheets and most other programs": (
        "Eine Tabelle für Tabellenprogramme und die meisten anderen"
    ),
    "Arrays for numpy; smaller, and written at once": (
        "Arrays für numpy; kleiner und sofort geschrieben"
    ),
    "A recording is being written; wait until it is done": (
        "Eine Aufzeichnung wird gerade geschrieben; warten, bis sie fertig ist"
    ),
    "Writing {name}; go on meanwhile": "{name} wird geschrieben; es geht solange weiter",
    "Saved: {name}": "Gespeichert: {name}",
    "Record from Start": "Von Anfang an aufzeichnen",
    "Record every tick from the beginning of a press": (
        "Jeden Schritt vom Beginn des Drückens an aufzeichnen"
    ),
    "Longest Recording": "Längste Aufzeichnung",
    "How long a recording may become, in minutes; then it stops by itself": (
        "Wie lang eine Aufzeichnung werden darf, in Minuten; dann endet sie von selbst"
    ),
    "Takes at most {size} of memory": "Braucht höchstens {size} Speicher",
    "Recorded: {seconds} s, {size}": "Aufgezeichnet: {seconds} s, {size}",
    "The recording is full; save it, or record anew": (
        "Die Aufzeichnung ist voll; speichern oder neu aufzeichnen"
    ),
    "{count} ticks are missing: the computer was too busy or its memory full": (
        "{count} Schritte fehlen: der Rechner war überlastet oder sein Speicher voll"
    ),
}
