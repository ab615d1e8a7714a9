//! The 2DIY's part of the tick allocates nothing, whatever its board does.

use crate::counting::counted;
use crate::haply::board::Cable;
use glam::DVec3;
use palpate_servo::device::haply::device::{Calibration, HaplyDevice};
use palpate_servo::device::haply::model::MODELS;
use palpate_servo::device::{Device, DeviceFrame, Reading};

#[test]
fn reading_and_writing_allocate_nothing() {
    assert!(counted(|| drop(std::hint::black_box(Box::new(1)))).1 >= 2);
    let cable = Cable::default();
    {
        let mut board = cable.board();
        board.to_board.reserve(1 << 12);
        board.to_host.reserve(1 << 12);
        board.asked.reserve(1 << 8);
    }
    let calibration = Calibration {
        degrees: MODELS[0].rest_degrees(),
        always: false,
    };
    let mut device = HaplyDevice::open(cable.clone(), &MODELS[0], calibration).unwrap();
    let (mut seen, mut other) = (0, 0);
    for tick in 0..20_000_i64 {
        let now = tick as f64 * 1e-3;
        let frame = DeviceFrame::default();
        let (reading, allocations) = counted(|| {
            let reading = device.read(now, 1e-3, &frame);
            device.write(DVec3::new(0.3, 0.2, 0.1), tick % 50 > 5, &frame);
            reading
        });
        assert_eq!(allocations, 0, "tick {tick}");
        match reading {
            Reading::At(_) => seen += 1,
            _ => other += 1,
        }
        let mut board = cable.board();
        // Silence, resets, a line that takes nothing, and noise.
        board.silent = (tick % 1000) > 950;
        board.full = (tick % 700) > 690;
        if tick % 400 == 100 {
            board.to_board.extend([0, 0]);
        }
        if tick % 90 == 89 {
            board.to_host.extend([0x20; 40]);
        }
        board.work();
        // As much as a terminal would hold.
        board.to_host.truncate(1000);
        board.to_board.truncate(1000);
    }
    assert!(seen > 15_000 && other > 300, "{seen} {other}");
    let report = device.report();
    assert!(report.crc_errors > 100 && report.unsent > 100, "{report:?}");
    assert!(cable.board().setups > 10);
}
