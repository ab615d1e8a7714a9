"""Shapes of large deformation and the felt force in Japanese."""

WORDS = {
    "Large Deformation": "大変形",
    "Shape": "形状",
    "How the deformed shape is computed. Can be changed while you press": (
        "変形した形状の計算方法。押している間も変更できます"
    ),
    "As the force is computed; large bends look swollen": (
        "力の計算と同じ。大きく曲げると膨らんで見えます"
    ),
    "Table (Paper)": "テーブル (論文)",
    "The paper's (16): stored large deformations, solved exactly; takes long to compute": (
        "論文の (16)。正確に解いて保存した大変形を使います。計算に時間がかかります"
    ),
    "Series": "級数",
    "Power series in the force: right for bends and moderate dents, in milliseconds": (
        "力のべき級数。曲げと適度なへこみに正しく、数ミリ秒で計算します"
    ),
    "Rotation-Strain": "回転とひずみ",
    "Bends and twists keep their size; nearest to the truth, without a table": (
        "曲げやねじりで大きさを保ちます。テーブルなしで最も真実に近い形です"
    ),
    "Felt Force": "感じる力",
    "How the force follows from large depths": "深く押したときの力の求め方",
    "The paper's: in proportion to the depth, however deep": (
        "論文の方法。どれほど深くても深さに比例します"
    ),
    "Corrected": "補正あり",
    "As a solid of large deformation: softer where it is pressed in far": (
        "大変形の固体と同じく、深く押し込んだ所は柔らかくなります"
    ),
    "Felt force {share} %": "感じる力 {share} %",
    "It is kept as far as it was computed, {share} %": ("計算済みの {share} % の形で保存しました"),
    "Linear where two fingers hold a slender part": "2本の指が細い部分を挟むと線形です",
    "Tools feel the linear force": "ツールは線形の力を感じます",
    "The linear force is felt": "線形の力を感じています",
    "Found around the touched place first, and kept": ("触れた場所の周りから求め、保存します"),
    "Whole Surface, About": "表面全体、約",
    "The linear shape is drawn": "線形の形状を描いています",
    "Shape {share} %": "形状 {share} %",
    "A Frame, About": "1 フレーム、約",
    "First Touch, About": "最初の接触、約",
    "Whole Table, About": "テーブル全体、約",
    "Memory, About": "メモリ、約",
    "Too large a body to be drawn 60 times a second this way": (
        "物体が大きすぎて、この方法では毎秒 60 回は描けません"
    ),
    "Computed around the touched place first, and kept": ("触れた場所の周りから計算し、保存します"),
}
