//! Multimedia class on Windows, time constraint on macOS.

/// Scheduling that the calling thread was given.
#[derive(Debug)]
pub struct Granted {
    text: String,
}

impl Granted {
    /// Text for people: the priority, or why there is none.
    pub fn text(&self) -> String {
        self.text.clone()
    }
}

/// Asks for the calling thread.
///
/// The crate thinks in buffers of sound. One frame at our rate is exactly one period on macOS,
/// where computation is then half of it: from 62.5 us at 8 kHz to 5 ms at 100 Hz, inside of the 50
/// us to 50 ms that the kernel takes. Windows' class has no such numbers.
pub fn ask(rate_hz: u32) -> Granted {
    let text = match audio_thread_priority::promote_current_thread_to_real_time(1, rate_hz.max(1)) {
        Ok(_) if cfg!(windows) => "multimedia class".to_owned(),
        Ok(_) => "time constraint".to_owned(),
        Err(error) => format!("none: {error}"),
    };
    Granted { text }
}

/// The calling thread ends; the system forgets by itself.
pub fn leave() {}
