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
}
