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
    "The paper's (16): corrected by stored large deformations, each solved exactly": (
        "論文の (16)。それぞれ正確に解いた大変形を保存して補正します"
    ),
    "Series": "級数",
    "As (16), but by power series: computed around the touched place while you press": (
        "(16) と同様ですがべき級数を使い、押している間に触れた場所の周りから計算します"
    ),
    "Rotation-Strain": "回転とひずみ",
    "Bends and twists keep their size; needs no table": (
        "曲げやねじりで大きさを保ちます。テーブルは不要です"
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
