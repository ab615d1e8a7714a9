"""Fingers, tools, pinching and pressure in Japanese."""

WORDS = {
    # What touches
    "Finger": "指",
    "What touches the surface": "表面に触れるもの",
    "Point": "点",
    "A needle's tip. The force depends on how finely the body is meshed": (
        "針の先。力はボディのメッシュの細かさに左右されます"
    ),
    "A point's force depends on how finely the body is meshed": (
        "点の力はボディのメッシュの細かさに左右されます"
    ),
    "Fingertip": "指先",
    "A sphere, such as a finger's end": "指の先のような球",
    "Plate": "板",
    "A flat rectangle whose face presses": "面で押す平らな長方形",
    "Rod": "棒",
    "A cylinder with round ends, lying on the surface": "表面に寝かせた、両端の丸い円柱",
    "Mesh": "メッシュ",
    "A mesh object of the scene, made convex": "シーンのメッシュオブジェクトを凸にしたもの",
    "Its convex hull presses; the object itself is not changed": (
        "凸包で押します。オブジェクト自体は変わりません"
    ),
    "Radius": "半径",
    "Radius of the fingertip or rod": "指先または棒の半径",
    "Length": "長さ",
    "Length of the rod without its round ends": "丸い端を除いた棒の長さ",
    "Width": "幅",
    "Width of the plate": "板の幅",
    "Depth": "奥行き",
    "Depth of the plate, across its width": "幅と直角の方向の板の奥行き",
    "Tool": "道具",
    "Mesh object that presses. Its convex hull is used; it is never changed": (
        "押すメッシュオブジェクト。凸包を使い、それ自体は変更しません"
    ),
    "Choose a mesh object of the scene as the tool": (
        "シーンのメッシュオブジェクトを道具として選んでください"
    ),
    "Turned": "向き",
    "How the tool is turned": "道具の向き",
    "Along Surface": "表面に沿う",
    "The tool's face lies on the surface where it is set down": (
        "置いた場所の表面に道具の面を合わせます"
    ),
    "Facing View": "ビューに合わせる",
    "The tool's face looks away from you, into the screen": "道具の面を画面の奥に向けます",
    "As Object": "オブジェクトと同じ",
    "The tool is turned as an object of the scene, also an animated one": (
        "シーンのオブジェクトと同じ向き。アニメーションにも従います"
    ),
    "Turned As": "向きの基準",
    "Object whose axes the tool has: its face looks along minus Z, a rod lies along X. Without "
    "one, a mesh that presses is turned as it is": (
        "道具の軸を決めるオブジェクト。面はマイナス Z を向き、棒は X に沿います。"
        "なければ、押すメッシュ自身の向きです"
    ),
    # How contact is computed
    "How the force follows from the depth": "深さから力を求める方法",
    "Consistent": "整合",
    "The touched point moves exactly as far as the finger, by the least force that does it": (
        "触れた点が指とちょうど同じだけ動きます。それに必要な最小の力です"
    ),
    "The touched point moves exactly as far as the finger": (
        "触れた点が指とちょうど同じだけ動きます"
    ),
    "Paper": "論文",
    "The paper's (11) to (14): inside triangles the surface stays a little short of the finger": (
        "論文の (11)から(14)。三角形の内部では、表面が指より少し手前に残ります"
    ),
    "As in the paper: inside triangles the surface stays a little short": (
        "論文のとおり。三角形の内部では表面が少し手前に残ります"
    ),
    # Who leads
    "Led By": "動かすもの",
    "An Empty of the scene leads the finger: by keyframes or moved by hand": (
        "シーンのエンプティが指を動かします。キーフレームでも手でも動かせます"
    ),
    "Empty whose place is the finger's: by keyframes, constraints or your hand": (
        "指の位置を決めるエンプティ。キーフレーム、コンストレイント、手で動かせます"
    ),
    "Second Finger": "2本目の指",
    "Who moves a second finger on the same body": "同じボディに触れる2本目の指を動かすもの",
    "One finger presses": "1本の指で押します",
    "An Empty of the scene leads a second finger": "シーンのエンプティが2本目の指を動かします",
    "A Haply 2DIY on a serial port of its own; it moves in a plane": (
        "専用のシリアルポートにつないだ Haply 2DIY。平面内で動きます"
    ),
    "A second haptic device on a serial port": "シリアルポートにつないだ2台目の力覚デバイス",
    "Empty whose place is the second finger's": "2本目の指の位置を決めるエンプティ",
    "Serial port of the second device: a path such as /dev/ttyACM1": (
        "2台目のデバイスのシリアルポート。/dev/ttyACM1 のようなパス"
    ),
    "Empty that says where the second device's origin and axes are": (
        "2台目のデバイスの原点と軸を決めるエンプティ"
    ),
    "Pinch leads two fingers with the pointer": "「つまむ」でポインターが2本の指を動かします",
    "The body was exchanged under the tool; leave with Escape and press again": (
        "道具の下のボディが替わりました。Escape で終了し、もう一度押してください"
    ),
    # Pinch
    "Pinch": "つまむ",
    "Squeeze the soft object between two fingers: drag each handle, the other stays where it is. "
    "Enter keeps the shape, Escape restores it. From scripts: EXEC_DEFAULT with at_1, by_1, at_2 "
    "and by_2": (
        "柔らかいオブジェクトを2本の指でつまみます。ハンドルをドラッグすると、もう一方は"
        "その場に残ります。Enter で形を残し、Escape で元に戻します。スクリプトからは "
        "EXEC_DEFAULT で at_1、by_1、at_2、by_2 を指定します"
    ),
    "At 2": "位置 2",
    "By 2": "移動 2",
    "Where the second finger touches, world coordinates": "2本目の指が触れる場所 (ワールド座標)",
    "How far the second finger moves, world axes": "2本目の指が動く量 (ワールド軸)",
    "Drag each handle inward": "それぞれのハンドルを内側へドラッグ",
    "Held: drag a handle, look around, or keep it": (
        "保持中: ハンドルをドラッグ、見回す、または形を残す"
    ),
    "The Empty leads: move it, or play the animation": (
        "エンプティが動かします。動かすか、アニメーションを再生してください"
    ),
    # Pressure
    "Pressure": "圧力",
    "Contact Area": "接触面積",
    "Largest Pressure": "最大圧力",
    "Show Pressure": "圧力を表示",
    "Draw where the tool touches, coloured by pressure": (
        "道具が触れている場所を圧力の色で描きます"
    ),
    # Along an animation
    "Press Along Animation": "アニメーションに沿って押す",
    "Let the animated tool press through the frames of the scene, and keep every frame's shape as "
    "a shape key that plays by itself. Escape is not heeded meanwhile; undo takes it back": (
        "アニメーションする道具でシーンのフレームを通して押し、各フレームの形を、ひとりでに"
        "再生されるシェイプキーとして残します。途中で Escape は効きません。元に戻すことはできます"
    ),
    "First Frame": "最初のフレーム",
    "Where it begins; -1 is the scene's first": "開始フレーム。-1 はシーンの最初",
    "Last Frame": "最後のフレーム",
    "Where it ends; -1 is the scene's last": "終了フレーム。-1 はシーンの最後",
    "Step": "間隔",
    "Keep every so many frames; the shape goes straight between them": (
        "この間隔のフレームを残します。その間の形は直線的に変わります"
    ),
    "This Frame Only": "このフレームだけ",
    "Press up to the current frame and keep only its shape": (
        "現在のフレームまで押し、その形だけを残します"
    ),
}
