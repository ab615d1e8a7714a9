//! Ports whose speed is that of the line.

/// Whether the port of this path is a chip that sends bit by bit, at the speed that it was told.
pub(super) fn is_wired(path: &str) -> bool {
    // A path may lead to the port by a link with a name that lasts.
    let real = std::fs::canonicalize(path).unwrap_or_else(|_| path.into());
    let name = real.to_string_lossy();
    const CHIPS: [&str; 8] = [
        "/dev/ttyUSB",
        "/dev/ttyS",
        "/dev/ttyAMA",
        "/dev/ttyTHS",
        "/dev/ttymxc",
        "/dev/ttyO",
        "/dev/cu.usbserial",
        "/dev/tty.usbserial",
    ];
    CHIPS.iter().any(|chip| name.starts_with(chip))
}
