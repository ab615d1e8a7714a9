//! The real-time thread of Palpate: a probe meets a soft body at 1 kHz.
//!
//! One tick reads a [`device`], moves the [`proxy`] (god object) on the rest [`surface`], computes
//! the [`contact`] force (11) to (14), passes it through [`coupling`] and [`safety`], gives it to the device and
//! publishes a snapshot ([`servo`]). [`thread`] runs it at its deadlines ([`clock`]) and [`recorder`] keeps
//! every tick; devices are [`pointer`], [`link`] and [`haply`]; [`closed_loop`] is the tick's force path
//! in a simulated plant. The tick allocates nothing, takes no lock and knows nothing
//! of Python; the optional `python` feature adds the thin binding.

mod asleep;
mod child_thread;
pub mod clock;
pub mod closed_loop;
pub mod closest;
pub mod codec;
pub mod compliance;
pub mod cones;
pub mod contact;
pub mod coupling;
pub mod cpu_time;
pub mod device;
pub mod durations;
mod early;
pub mod exchange;
pub mod face;
pub mod felt;
pub mod felt_coupling;
pub mod finger;
pub mod haply;
mod joining;
mod line;
pub mod link;
mod normals;
pub mod passivity;
pub mod pointer;
pub mod port;
pub mod pressed_patch;
pub mod proxy;
#[cfg(feature = "python")]
mod python;
mod realtime;
pub mod recorder;
mod response;
pub mod rhythm;
pub mod safety;
mod schedule;
pub mod servo;
pub mod several;
mod sleeper;
pub mod small_matrix;
pub mod snapshot;
mod softened;
mod speedometer;
pub mod stages;
pub mod state;
pub mod surface;
pub mod table;
pub mod thread;
pub mod tip;
pub mod tool;
pub mod tree;
mod turning;
mod whole;
