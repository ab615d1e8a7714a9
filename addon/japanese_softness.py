"""Softness in the maker's words, in Japanese."""

WORDS = {
    "Shore 00": "ショア 00",
    "Shore A": "ショア A",
    "Softer than this scale tells": "このスケールの範囲より軟らかい",
    "Firmer than this scale tells": "このスケールの範囲より硬い",
    "Soft polyurethane foam": "軟質ウレタンフォーム",
    "Latex foam": "ラテックスフォーム",
    "EVA foam (Shore A 30)": "EVA フォーム (ショア A 30)",
    "Gelatine 3 %": "ゼラチン 3 %",
    "Gelatine 5 %": "ゼラチン 5 %",
    "Ballistic gel 10 %": "バリスティックゼラチン 10 %",
    "Firm toy stuffing": "硬めのぬいぐるみの綿",
    "Skin over flesh": "肉の上の皮膚",
    "Scale": "スケール",
    "Shore": "ショア硬さ",
    "Which durometer the Shore value is of": "ショア硬さのスケール",
    "For gels, soft silicones and foams: a ball on a light spring": (
        "ゲル、軟質シリコーン、フォーム用。弱いばねの球"
    ),
    "For rubbers: a blunt cone on a stronger spring": "ゴム用。強いばねの円錐台",
    "Softness as data sheets tell it, from 10 to 90: what a durometer reads on a thick "
    "block. Sets Young's modulus, and follows it": (
        "データシートのショア硬さ (10 から "
        "90)。厚いブロックでの硬度計の値です。ヤング率を設定し、ヤング率に追従します"
    ),
    "Softness": "柔らかさ",
    "Measured At": "測定位置",
    "3D Cursor": "3D カーソル",
    "Where durometer and curve press, unless you click a place": (
        "クリックで場所を選ばないときに硬度計と曲線が押す場所"
    ),
    "Selected Vertices": "選択した頂点",
    "The surface point nearest to the 3D cursor": "3D カーソルに最も近い表面の点",
    "The surface point nearest to the middle of the vertices selected in Edit Mode": (
        "編集モードで選択した頂点の中心に最も近い表面の点"
    ),
    "Pick": "クリックで指定",
    "Click the place in the view": "ビュー内で場所をクリック",
    "Click the place on the object; right click to leave": (
        "オブジェクト上の場所をクリック、右クリックで中止"
    ),
    "Reading": "読み",
    "On a Thick Block": "厚いブロックでは",
    "Text Block": "テキストブロック",
    "Stiffness": "剛性",
    "Force": "力",
    "Depth": "深さ",
    "Place": "位置",
    "Colour": "色",
    "A colour of the map": "マップの色",
    "Fingertip Radius": "指先の半径",
    "How large what presses is, for curve and map; 0 for a point": (
        "曲線とマップで押すものの大きさ。0 は点"
    ),
    "Read Durometer": "硬度計を読む",
    "Press the indenter of the chosen scale into the object, and read what the device would "
    "show there": ("選んだスケールの押針を押し込み、硬度計が示す値を読みます"),
    "Force Curve": "力の曲線",
    "Press straight in, deeper and deeper, and write force against depth into a text block": (
        "まっすぐ深く押し、深さと力の表をテキストブロックに書きます"
    ),
    "How far to press; 0 for as far as is small there": "押す深さ。0 はその場所で小さい深さ",
    "The surface point nearest to this is asked, world coordinates. Without one, the "
    "panel's Measured At says where": (
        "これに最も近い表面の点で測定します (ワールド座標)。指定がなければ「測定位置」に従います"
    ),
    "Map Softness": "柔らかさをマップ",
    "Colour the object by how hard a fingertip must push for each millimetre: dark is "
    "soft, yellow is firm. Writes the colour attribute Palpate Softness and shows it in "
    "the view": (
        "指先で 1 "
        "ミリ押すのに要る力で色を付けます。暗い色は柔らかく、黄色は硬い所です。カラー属性「P"
        "alpate Softness」を書いて、ビューに表示します"
    ),
    "Remove Softness Map": "柔らかさのマップを削除",
    "Delete the colour attribute Palpate Softness": "カラー属性「Palpate Softness」を削除します",
    "Viewport Shading, Color, Attribute shows it": (
        "ビューポートシェーディングのカラーを「属性」にすると見えます"
    ),
}
