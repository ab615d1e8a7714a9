"""Force, its loop, and recordings in Japanese."""

WORDS = {
    # The servo's states
    "Waiting": "待機中",
    "Free": "フリー",
    "Touching": "接触中",
    "Force Rises": "力を復帰中",
    "Fault": "異常",
    "Force Off": "力をオフ",
    "Force On": "力をオン",
    "Stopped": "停止",
    "No force yet: the device is not ready": "まだ力は出ません。デバイスの準備ができていません",
    "Force comes as soon as the surface is touched": "表面に触れるとすぐに力が出ます",
    "The force rises slowly": "力がゆっくり強くなります",
    "No force until the fault is gone": "異常がなくなるまで力は出ません",
    "No force until it is switched on": "オンにするまで力は出ません",
    "The force loop does not run": "力の計算は動いていません",
    # Reasons
    "The device answers but tells no position yet; plug it in again if it stays so": (
        "デバイスは応答しましたが、位置がまだ届きません。続く場合は接続し直してください"
    ),
    "The device is not ready: calibrate it or switch on its motors": (
        "デバイスの準備ができていません。校正するか、モーターの電源を入れてください"
    ),
    "The force is switched off; Space or Force On brings it back": (
        "力はオフです。スペースキーか「力をオン」で戻ります"
    ),
    "A button of the device is held; let it go and the force comes back": (
        "デバイスのボタンが押されています。放すと力が戻ります"
    ),
    "The device is ready; the force rises slowly": (
        "デバイスの準備ができました。力がゆっくり強くなります"
    ),
    "Switched on; the force rises slowly": "オンになりました。力がゆっくり強くなります",
    "The button was let go; the force rises slowly": (
        "ボタンが放されました。力がゆっくり強くなります"
    ),
    "The body is another one now; the force rises slowly": (
        "物体が替わりました。力がゆっくり強くなります"
    ),
    "The probe is inside the body: lead it out, then touch from outside": (
        "プローブが物体の中にあります。外に出してから触れてください"
    ),
    "The force loop has not started yet": "力の計算はまだ始まっていません",
    "Pressing has ended": "押す操作は終わりました",
    "The fault is gone; the force rises slowly": "異常がなくなりました。力がゆっくり強くなります",
    "The board is being set up; leave the handle where it is": (
        "基板を設定しています。ハンドルを動かさないでください"
    ),
    "The board lost track of its handle: leave, put it in its rest pose, and press again": (
        "基板がハンドルの位置を見失いました。終了し、ハンドルを休止位置に置いて、もう一度押して"
        "ください"
    ),
    "The arms are stretched; bring the handle back to the middle": (
        "アームが伸び切っています。ハンドルを中央に戻してください"
    ),
    # Limits
    "Held back: the force rises slowly": "抑制中: 力がゆっくり強くなります",
    "Held back: the largest force is reached": "抑制中: 最大の力に達しました",
    "Held back: the force changes too fast": "抑制中: 力の変化が速すぎます",
    # Faults
    "Waiting for the device: check its port, cable and power": (
        "デバイスの応答を待っています: ポート、ケーブル、電源を確認してください"
    ),
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
    "The computer stood still for a moment, so the device was let go; pressing goes on by itself": (
        "コンピューターが一瞬止まったため力を切りました。自動的に続きます"
    ),
    "The force loop has failed, so pressing has ended; press again": (
        "力の計算が停止し、押す操作を終了しました。もう一度押してください"
    ),
    "Faults": "異常",
    "Unplugged": "取り外し",
    "Silent": "応答なし",
    "Too Fast": "速すぎ",
    "Invalid Number": "無効な数値",
    "Other Version": "版の違い",
    "Fault of the Device": "デバイスの異常",
    "Stood Still": "一時停止",
    "Force Loop Failed": "計算の停止",
    # Switching it
    "Let the device go limp at once, or let its force rise again slowly. Space does it too": (
        "デバイスの力をすぐに切る、またはゆっくり戻します。スペースキーでもできます"
    ),
    "The device gives": "デバイスの力",
    "Space  Force Off": "スペース  力をオフ",
    "Space  Force On": "スペース  力をオン",
    # Touch
    "Touch": "感触",
    "Smooth Facets": "面を滑らかに",
    "Feel the smooth surface that the facets stand for, instead of their edges": (
        "面の継ぎ目ではなく、面が表す滑らかな表面を感じます"
    ),
    "Static Friction": "静止摩擦",
    "How well the surface holds a resting finger: sideways force over pressing force. "
    "0 is slippery, felt is about 0.5, rubber 1": (
        "止まった指を表面が留める強さ (横の力と押す力の比)。0 は滑りやすく、"
        "フェルトは約 0.5、ゴムは 1"
    ),
    "Sliding": "動摩擦",
    "Dynamic Friction": "動摩擦",
    "The same while the finger slides; never more than the static one": (
        "指が滑っている間の同じ比。静止摩擦を超えません"
    ),
    # Force loop
    "Force Loop": "力の計算",
    "Rate": "レート",
    "How often a second the force is computed, in hertz. Firmer bodies want more, "
    "slow devices and computers less": (
        "1 秒間に力を計算する回数 (Hz)。硬い物体では高く、遅いデバイスやコンピューターでは低く"
    ),
    "While you press, its figures appear here": "押している間、ここに数値が表示されます",
    "Ticks": "計算回数",
    "Late by 0.2 ms": "0.2 ms の遅れ",
    "Late by 1 ms": "1 ms の遅れ",
    "Longest Gap": "最長の間隔",
    "Priority": "優先度",
    "No real-time priority: {reason}": "リアルタイム優先度がありません: {reason}",
    "Time in a Tick: Mean, 99 %": "1 回の時間: 平均、99 %",
    "Read": "読込",
    "Proxy": "プロキシ",
    "Write": "書込",
    "Connection": "接続",
    "Received": "受信",
    "Sent": "送信",
    "Lost": "欠落",
    "Damaged": "破損",
    "Out of Order": "順序違い",
    "Not Sent": "未送信",
    "Opened Again": "再接続",
    "Stable Contact": "安定した接触",
    "Let the motors feel no contact that is too stiff for them and your hand to hold without "
    "shaking. The shape stays as it is": (
        "モーターと手が震えずに保てないほど硬い接触を、モーターに伝えません。形は変わりません"
    ),
    "Own Values": "値を指定",
    "Choose yourself what keeps the contact stable, for a device that you know": (
        "接触を安定させる値を自分で決めます (よく知るデバイス向け)"
    ),
    "Largest Stiffness": "最大の剛性",
    "The stiffest contact that the motors feel, in newtons per metre": (
        "モーターが感じる最も硬い接触 (N/m)"
    ),
    "Stiffness": "剛性",
    "Damping": "減衰",
    "What brakes the device in a contact of that stiffness, in newton seconds per metre; "
    "softer contacts get their share": (
        "その硬さの接触でデバイスにかかる制動 (N s/m)。柔らかい接触では比例して弱くなります"
    ),
    "Passivity Control": "受動性制御",
    "Watch the energy that the motors give, and brake away what no soft body could have stored": (
        "モーターが出すエネルギーを監視し、柔らかい物体が蓄えられない分を制動で取り除きます"
    ),
    # Devices
    "Haply 2DIY": "Haply 2DIY",
    "A Haply 2DIY on its serial port; it moves in a plane": (
        "シリアルポートの Haply 2DIY。平面内を動きます"
    ),
    "Kind": "種類",
    "Which device is simulated": "シミュレートするデバイス",
    "Three Axes": "3 軸",
    "A device that speaks Palpate's serial link": "Palpate のシリアル通信を話すデバイス",
    "A Haply 2DIY with its board; it moves in a plane": "基板付きの Haply 2DIY。平面内を動きます",
    "Model": "モデル",
    "Which of the 2DIYs it is": "2DIY のどれか",
    "Motors side by side, the newest boards": "モーターが並んだ最新の基板",
    "Motors side by side, earlier boards": "モーターが並んだ以前の基板",
    "Motors on one axis": "モーターが同軸",
    "Dev Kit": "開発キット",
    "The small early kit": "初期の小型キット",
    "Handle at Rest": "ハンドルは休止位置",
    "The handle lies in its rest pose now: let the board count its angles from there anew, "
    "also if it was in use before": (
        "ハンドルは今、休止位置にあります。使用済みの基板でも、そこから角度を数え直します"
    ),
    "Before Press, put the handle in its rest pose and leave it there": (
        "押す前に、ハンドルを休止位置に置いたままにしてください"
    ),
    "Show Workspace": "可動範囲を表示",
    "Draw in the view where the device reaches": "デバイスの届く範囲をビューに描きます",
    # Recording
    "Recording": "記録",
    "Record": "記録開始",
    "Stop Recording": "記録を停止",
    "Record every tick of the force loop: time, probe, contact, forces and state. A new "
    "recording replaces the one before": (
        "力の計算を毎回記録します (時間、プローブ、接触点、力、状態)。新しい記録は前の記録を"
        "置き換えます"
    ),
    "Save Recording...": "記録を保存...",
    "Write the recorded ticks to a file, also while pressing goes on": (
        "記録をファイルに書き出します。押している間でもできます"
    ),
    "How the file is written": "ファイルの形式",
    "A table for spreadsheets and most other programs": "表計算ソフトなど多くのソフト向けの表",
    "Arrays for numpy; smaller, and written at once": "numpy の配列。小さく、すぐに書き出せます",
    "A recording is being written; wait until it is done": (
        "記録を書き込み中です。終わるまでお待ちください"
    ),
    "Writing {name}; go on meanwhile": "{name} を書き込み中。作業は続けられます",
    "Saved: {name}": "保存済み: {name}",
    "Record from Start": "最初から記録",
    "Record every tick from the beginning of a press": "押し始めから毎回記録します",
    "Longest Recording": "最長の記録",
    "How long a recording may become, in minutes; then it stops by itself": (
        "記録の最大の長さ (分)。達すると自動的に止まります"
    ),
    "Takes at most {size} of memory": "メモリを最大 {size} 使います",
    "Recorded: {seconds} s, {size}": "記録済み: {seconds} 秒、{size}",
    "The recording is full; save it, or record anew": (
        "記録がいっぱいです。保存するか、記録し直してください"
    ),
    "{count} ticks are missing: the computer was too busy or its memory full": (
        "{count} 回分が欠けています。コンピューターの負荷かメモリ不足が原因です"
    ),
}
