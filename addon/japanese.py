"""The interface in Japanese."""

WORDS = {
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
    "Rebuild Body takes them over": "「物体を再計算」で反映されます",
    "Pins changed since the bake": "ベイク後に固定が変更されました",
    "Poisson's ratio changed since the bake": "ベイク後にポアソン比が変更されました",
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
    "Nodes": "節点",
    "Tetrahedra": "四面体",
    "Free Surface Nodes": "自由な表面節点",
    "Memory": "メモリ",
    "Bake Time": "ベイク時間",
    "Young's (Pa)": "ヤング率 (Pa)",
    "Select a mesh object": "メッシュオブジェクトを選択してください",
    # View
    "Press on the surface and drag": "表面を押してドラッグ",
    "Pressing": "押しています",
    "Waiting for the device: check its port, cable and power": (
        "デバイスの応答を待っています: ポート、ケーブル、電源を確認してください"
    ),
    "Above the surface: drag inward, or turn the wheel": (
        "表面の外です: 内側へドラッグするか、ホイールを回してください"
    ),
    "Held: look around, keep it, or press elsewhere": "保持中: 視点移動、保存、別の場所を押す",
    "The device presses": "デバイスが押しています",
    "Device away": "デバイスなし",
    "Esc  Leave": "Esc  終了",
    "Wheel  Deeper": "ホイール  深く",
    "Enter  Keep shape      Esc  Restore": "Enter  形を保存      Esc  元に戻す",
    "The device gives": "デバイスの力",
    "The device is unplugged; plug it in again and pressing goes on": (
        "デバイスが外れました。つなぎ直すと続けられます"
    ),
    "The device is silent; check its cable and power, pressing goes on when it speaks": (
        "デバイスの応答がありません。ケーブルと電源を確認してください。応答すると続きます"
    ),
    "The device moved too fast and was let go; hold still and pressing goes on": (
        "デバイスが速すぎるため力を切りました。静止させると続きます"
    ),
    "The device sent a position that is no number; pressing goes on when it recovers": (
        "デバイスの位置が数値ではありません。回復すると続きます"
    ),
    "The device speaks another version of the link; update its firmware": (
        "デバイスの通信の版が異なります。ファームウェアを更新してください"
    ),
    "The device reports a fault of its own; see its manual, or plug it in again": (
        "デバイス自身の異常です。説明書を見るか、つなぎ直してください"
    ),
    "The force loop has failed; leave with Escape and press again": (
        "力の計算が停止しました。Esc で終了し、もう一度押してください"
    ),
    "Nothing is pressed yet, so there is no shape to keep": (
        "まだ押されていないので、保存する形がありません"
    ),
    # Properties
    "A usual soft material, as a start": "出発点となる一般的な柔らかい材質",
    "Plush toy": "ぬいぐるみ",
    "Jelly": "ゼリー",
    "Soft cube of the paper": "論文の柔らかい立方体",
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
        "四面体の辺の目標長さ (対角線に対する割合)。半分にすると節点は約 8 倍"
    ),
    "Tolerance": "許容差",
    "How far the body may stray from the mesh, as a share of the diagonal. Smaller takes longer": (
        "物体とメッシュのずれの許容値 (対角線に対する割合)。小さいほど時間がかかります"
    ),
    "Simplify Above": "簡略化の上限",
    "Denser meshes are simplified to this many triangles before the bake. "
    "What you see stays as dense as it is": (
        "これより細かいメッシュはこの三角形数まで簡略化してからベイクします。表示は変わりません"
    ),
    "Time Limit": "制限時間",
    "Give up filling with tetrahedra after this many seconds": (
        "この秒数で四面体分割をあきらめます"
    ),
    "Press With": "押す手段",
    "Who moves the probe": "プローブを動かすもの",
    "Pointer": "ポインター",
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
    "Poisson's ratio set now. For a body file that is missing or damaged": (
        "このファイル内の四面体から、今の固定とポアソン比で物体を計算し直します。"
        "物体ファイルがない、または壊れているときに使います"
    ),
    "Look for serial ports again": "シリアルポートを探し直します",
    "Delete the body and its file. Mesh, pins and kept shapes stay": (
        "物体とそのファイルを削除します。メッシュ、固定、保存した形は残ります"
    ),
}
