"""The interface in Japanese."""

from .japanese_finger import WORDS as FINGER_WORDS
from .japanese_force import WORDS as FORCE_WORDS
from .japanese_shape import WORDS as SHAPE_WORDS
from .japanese_softness import WORDS as SOFTNESS_WORDS

WORDS = {
    **FORCE_WORDS,
    **SOFTNESS_WORDS,
    **FINGER_WORDS,
    **SHAPE_WORDS,
    # Panel
    "Pins": "固定",
    "Device": "デバイス",
    "Bake": "ベイク",
    "Make Soft": "柔らかくする",
    "Make Soft Again": "もう一度柔らかくする",
    "Rebuild Body": "物体を再計算",
    "Press": "押す",
    "Cancel": "キャンセル",
    "Make Pin Group": "固定グループを作成",
    "Refresh Devices": "デバイスを再検索",
    "Remove Softness": "柔らかさを削除",
    "Choose a material and pins, then press Make Soft": (
        "材質と固定を選び、「柔らかくする」を押してください"
    ),
    "Ready to press": "押す準備ができました",
    "The body file is missing; Press computes it again": (
        "物体ファイルがありません。「押す」で再計算されます"
    ),
    "Press Make Soft Again": "「もう一度柔らかくする」を押してください",
    "The body file is missing; press Rebuild Body": (
        "物体ファイルがありません。「物体を再計算」を押してください"
    ),
    "The body file is damaged; press Rebuild Body": (
        "物体ファイルが壊れています。「物体を再計算」を押してください"
    ),
    "The faces are connected differently than when it was baked": (
        "面のつながりがベイク時と異なります"
    ),
    "The object's scale or the scene's unit scale changed since the bake": (
        "ベイク後にオブジェクトのスケールか単位が変更されました"
    ),
    "The shape was edited since the bake": "ベイク後に形状が編集されました",
    "Enter keeps the shape, Escape restores it": "Enter で形を保存、Esc で元に戻します",
    "There is no such vertex group": "この頂点グループはありません",
    "Only the base mesh is baked: apply the Mirror modifier first": (
        "元のメッシュだけがベイクされます。先にミラーモディファイアーを適用してください"
    ),
    "Nodes": "ノード",
    "Tetrahedra": "四面体",
    "Free Surface Nodes": "自由な表面ノード",
    "Memory": "メモリ",
    "Bake Time": "ベイクタイム",
    "Young's (Pa)": "ヤング率 (Pa)",
    "Select a mesh object": "メッシュオブジェクトを選択してください",
    "Update Pins": "固定を反映",
    "Fit Memory": "メモリに合わせる",
    "Compress It": "圧縮する",
    "Use Edge Length {length}": "辺の長さを {length} にする",
    "{time} left": "残り {time}",
    "About {nodes} nodes in {time}": "約 {nodes} ノード、{time}",
    "Takes {needed} of memory; {available} are free": (
        "メモリ {needed} が必要です。空きは {available} です"
    ),
    "The Next Bake, About": "次のベイク (およそ)",
    "Peak Memory": "最大メモリ",
    "File": "ファイル",
    "Uncompressed": "非圧縮時",
    "Stiff Region": "硬い領域",
    "Method": "方式",
    "Baked Body": "ベイク済みの物体",
    "Bone in flesh: a closed shell inside the mesh, as a vertex group": (
        "肉の中の骨: メッシュ内の閉じた殻を頂点グループにします"
    ),
    "Linear: as in the paper, right up to about 0.4": "リニア: 論文どおり。約 0.4 まで正確です",
    "Smoothed: does not lock near 0.5": "平滑化: 0.5 付近でも硬くなりません",
    "These pins were computed before: no bake needed": "この固定は計算済みです。ベイクは不要です",
    "More is pinned: takes effect in about {time}, no bake needed": (
        "固定が増えました。約 {time} で反映され、ベイクは不要です"
    ),
    "Less is pinned than before: needs a bake": "固定が減りました。ベイクが必要です",
    "The pins changed and need a bake": "固定が変わりました。ベイクが必要です",
    "Press does it by itself, too": "「押す」でも自動で反映されます",
    "These pins would hold the whole surface; pin less": (
        "表面全体が固定されてしまいます。固定を減らしてください"
    ),
    "Changed since the bake: {names}": "ベイク後の変更: {names}",
    "Rebuild Body takes it over": "「物体を再計算」で反映されます",
    "Make Soft Again takes it over": "「もう一度柔らかくする」で反映されます",
    # A bake
    "The body is ready; leave Edit Mode to receive it": (
        "物体の準備ができました。編集モードを終了すると反映されます"
    ),
    "Starting": "開始しています",
    "Filling with tetrahedra": "四面体で充填しています",
    "Comparing with the mesh": "メッシュと比較しています",
    "Assembling the stiffness": "剛性を組み立てています",
    "Inverting the stiffness": "剛性の逆を計算しています",
    "reading the mesh": "メッシュの読み込み",
    "simplifying the surface": "表面の簡略化",
    "inserting the surface": "表面の挿入",
    "improving tetrahedra": "四面体の改善",
    "finishing": "仕上げ",
    "Compressing the compliance": "コンプライアンスを圧縮しています",
    "Planning the elimination": "消去を計画しています",
    "Writing the body file": "物体ファイルを書き込んでいます",
    # View
    "Press on the surface and drag": "表面を押してドラッグ",
    "Pressing": "押しています",
    "Above the surface: drag inward, or turn the wheel": (
        "表面の外です: 内側へドラッグするか、ホイールを回してください"
    ),
    "Held: look around, keep it, or press elsewhere": "保持中: 視点移動、保存、別の場所を押す",
    "Esc  Leave": "Esc  終了",
    "Wheel  Deeper": "ホイール  深く",
    "Enter  Keep shape      Esc  Restore": "Enter  形を保存      Esc  元に戻す",
    "Nothing is pressed yet, so there is no shape to keep": (
        "まだ押されていないので、保存する形がありません"
    ),
    # Properties
    "A usual soft material, as a start": "出発点となる一般的な柔らかい材質",
    "Plush toy": "ぬいぐるみ",
    "Jelly": "ゼリー",
    "Paper's soft cube": "論文の柔らかい立方体",
    "Upholstery foam": "ウレタンフォーム",
    "Soft silicone (Shore 00-30)": "軟質シリコーン (Shore 00-30)",
    "Firm silicone (Shore A 20)": "硬質シリコーン (Shore A 20)",
    "Rubber (Shore A 50)": "ゴム (Shore A 50)",
    "Custom": "カスタム",
    "Young's modulus and Poisson's ratio as set below": "下で設定したヤング率とポアソン比",
    "Young's Modulus": "ヤング率",
    "Stiffness in pascal. Takes effect at once, without a new bake": (
        "硬さ (パスカル)。ベイクし直さずにすぐ反映されます"
    ),
    "Poisson's Ratio": "ポアソン比",
    "How much it bulges sideways: 0 like cork, near 0.5 like rubber or water. Needs Rebuild Body": (
        "横へのふくらみ: 0 はコルク、0.5 近くはゴムや水。「物体を再計算」が必要です"
    ),
    "Pin": "固定",
    "Which part never moves": "動かない部分",
    "Below Height": "高さ以下",
    "Everything in the lowest part of the object, as it stands": ("今の姿勢での最も低い部分すべて"),
    "Vertices with a weight of 0.5 or more": "ウェイトが 0.5 以上の頂点",
    "Share of the object's height in world Z below which it is pinned": (
        "ワールド Z の高さの割合。これより下が固定されます"
    ),
    "Share of the object's height in world Z below which vertices are pinned": (
        "ワールド Z の高さの割合。これより下の頂点が固定されます"
    ),
    "Vertex group that is pinned": "固定する頂点グループ",
    "Edge Length": "辺の長さ",
    "Wanted edge length of the tetrahedra, as a share of the object's diagonal. "
    "Half the length: about eight times the nodes": (
        "四面体の辺の目標長さ (対角線に対する割合)。半分にするとノードは約 8 倍"
    ),
    "Tolerance": "許容範囲",
    "How far the body may stray from the mesh, as a share of the diagonal. Smaller takes longer": (
        "物体とメッシュのずれの許容値 (対角線に対する割合)。小さいほど時間がかかります"
    ),
    "Simplify Above": "簡略化の上限",
    "Denser meshes are simplified to this many triangles before the bake. "
    "What you see stays as dense as it is": (
        "これより細かいメッシュはこの三角形数まで簡略化してからベイクします。表示は変わりません"
    ),
    "Time Limit": "時間制限",
    "Give up filling with tetrahedra after this many seconds": (
        "この秒数で四面体分割をあきらめます"
    ),
    "Press With": "押す手段",
    "Who moves the probe": "プローブを動かすもの",
    "Pointer": "ポインタ",
    "Mouse, pen or trackpad press on the surface": "マウス、ペン、トラックパッドで押します",
    "Simulated Device": "模擬デバイス",
    "A program that behaves like a haptic device": "力覚デバイスのように振る舞うプログラム",
    "Serial Device": "シリアルデバイス",
    "A haptic device on a serial port": "シリアルポートの力覚デバイス",
    "Serial port of the device: one from the list, or a path typed in": (
        "デバイスのシリアルポート: 一覧から選ぶか、パスを入力"
    ),
    "Device Frame": "デバイス座標系",
    "Empty that says where the device's origin and axes are. Without one they are the object's": (
        "デバイスの原点と軸を示すエンプティ。なければオブジェクトのものを使います"
    ),
    "Motion Scale": "動きの倍率",
    "How far the probe moves per movement of the device": (
        "デバイスの動きに対するプローブの動きの比"
    ),
    "Automatic": "自動",
    "Smoothed where linear tetrahedra would be too stiff, linear elsewhere": (
        "線形の四面体が硬すぎる場合は平滑化、それ以外はリニア"
    ),
    "Linear": "リニア",
    "The paper's. Too stiff as Poisson's ratio comes near 0.5": (
        "論文の方式。ポアソン比が 0.5 に近いと硬すぎます"
    ),
    "Smoothed": "平滑化",
    "Right for rubber and silicone too. The bake takes longer": (
        "ゴムやシリコーンでも正確です。ベイクは長くなります"
    ),
    "Full while it is small, compressed where it would be large": (
        "小さいうちはフル、大きくなる場合は圧縮"
    ),
    "Full": "フル",
    "Every number is kept. Memory grows with the square of the surface": (
        "すべての数値を保持します。メモリは表面の二乗で増えます"
    ),
    "Compressed": "圧縮",
    "Takes a tenth of the memory or less, for large bodies": (
        "メモリは十分の一以下。大きな物体向けです"
    ),
    "Vertex group that is stiffer or softer than the material. A closed shell inside the mesh "
    "makes all that it encloses stiff: bone in flesh. Needs Rebuild Body": (
        "材質より硬い、または柔らかい頂点グループ。メッシュ内の閉じた殻は、その内側すべてを硬く"
        "します (肉の中の骨)。「物体を再計算」が必要です"
    ),
    "Times as Stiff": "硬さの倍率",
    "Factor on Young's modulus where the group's weight is 1; halfway painted weights feel "
    "halfway": (
        "グループのウェイトが 1 の場所でのヤング率の倍率。途中のウェイトは途中の硬さになります"
    ),
    "Formulation": "定式化",
    "How tetrahedra resist. Needs Rebuild Body": "四面体の抵抗の求め方。「物体を再計算」が必要です",
    "Compliance": "コンプライアンス",
    "How the computed response is kept. Needs Rebuild Body": (
        "計算された応答の保存方法。「物体を再計算」が必要です"
    ),
    "Largest Error": "最大誤差",
    "By how much compressing may change the shape under any touch. The force that is felt "
    "stays exact": ("圧縮による、触れたときの形の変化の上限。感じる力は正確なままです"),
    # Preferences
    "What new files press with": "新しいファイルでの押す手段",
    "Largest Force": "最大の力",
    "A device never gives more than this, in newtons, nor more than it says itself": (
        "デバイスはこれ (ニュートン) と自身の上限を超える力を出しません"
    ),
    "Pointer Sensitivity": "ポインター感度",
    "How deep a drag presses: 1 follows the pointer": ("ドラッグで押す深さ: 1 でポインターに追従"),
    "Body Folder": "物体フォルダー",
    "Where bodies of files not yet saved are kept. Empty: the extension's own user folder": (
        "未保存ファイルの物体の保存先。空欄なら拡張機能のユーザーフォルダー"
    ),
    "Probe": "プローブ",
    "Contact": "接触点",
    "Force": "力",
    "Probe Size": "プローブの大きさ",
    "Radius of the probe on the screen": "画面上のプローブの半径",
    "Arrow Length": "矢印の長さ",
    "Length of the arrow for large forces; half of it at 0.3 N": (
        "大きな力での矢印の長さ。0.3 N でその半分"
    ),
    "Files": "ファイル",
    "In the View": "ビュー内",
    # Operators
    "Stop the bake; nothing is changed and nothing is left": (
        "ベイクを中止します。何も変更されず、何も残りません"
    ),
    "Fill the mesh with tetrahedra and compute how it gives way; "
    "the mesh itself stays as it is. Escape cancels": (
        "メッシュを四面体で満たし、変形のしかたを計算します。メッシュ自体は変わりません。Esc で中止"
    ),
    "Put all vertices below this share of the object's height, as it stands now, "
    "into the vertex group Pinned": (
        "今の姿勢で高さのこの割合より下の頂点を、頂点グループ Pinned に入れます"
    ),
    "Press the soft object with the pointer or a device. Enter keeps the shape, "
    "Escape restores it. From scripts: EXEC_DEFAULT with at and by": (
        "ポインターやデバイスで柔らかい物体を押します。Enter で形を保存、Esc で元に戻します。"
        "スクリプトからは at と by を付けて EXEC_DEFAULT"
    ),
    "At": "位置",
    "The surface point nearest to this is touched, world coordinates": (
        "これに最も近い表面の点に触れます (ワールド座標)"
    ),
    "By": "移動",
    "How far it is moved, world axes": "動かす量 (ワールド軸)",
    "Keep": "保存",
    "Keep the shape as a shape key": "形をシェイプキーとして保存します",
    "Compute the body again from the tetrahedra stored in this file, with the pins and "
    "the material set now. Also for a body file that is missing or damaged": (
        "このファイル内の四面体から、今の固定とポアソン比で物体を計算し直します。"
        "物体ファイルがない、または壊れているときに使います"
    ),
    "Look for serial ports again": "シリアルポートを探し直します",
    "Delete the body and its file. Mesh, pins and kept shapes stay": (
        "物体とそのファイルを削除します。メッシュ、固定、保存した形は残ります"
    ),
    "Hold the body where the pins are now. More pins take about a second and no bake; so do "
    "pins that were baked before": (
        "現在の固定を物体に反映します。固定の追加は約 1 "
        "秒でベイク不要、以前ベイクした固定も同様です"
    ),
    "Change the bake's settings so that the memory of this machine suffices": (
        "このマシンのメモリに収まるようにベイクの設定を変えます"
    ),
    "What is changed": "変更する項目",
    "Keep the computed response compressed": "計算された応答を圧縮して保存します",
    "Coarser": "粗く",
    "Take the smallest edge length that fits": "収まる最小の辺の長さにします",
}
