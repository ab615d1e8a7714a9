//! A hAPI board in memory, as its program reads: command by command, with nothing to hold on to.

use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use palpate_servo::device::haply::message::TORQUE_BYTES;
use palpate_servo::device::serial::wire::{Opener, Wire};

/// Torque at full duty, N m.
pub const FULL: f32 = 0.156;
/// Bytes are read without waiting where there are none.
const NOTHING: u8 = 0xFF;

#[derive(Default)]
pub struct Board {
    pub to_board: VecDeque<u8>,
    pub to_host: VecDeque<u8>,
    pub gone: bool,
    pub silent: bool,
    pub full: bool,
    /// The line takes nothing so many times.
    pub refusals: usize,
    /// Its guardian was told that the device was let go.
    pub dismissed: bool,
    /// Address of both motors and both encoders; 0 before a setup.
    pub address: u8,
    /// Torques of ports 0 and 1, N m.
    pub torques: [f32; 2],
    /// Own counts of the encoders of ports 0 and 1.
    pub counts: [i64; 2],
    pub zero: [i64; 2],
    pub resolution: [f32; 2],
    pub setups: usize,
    pub resets: usize,
    /// Torques of ports 0 and 1 as the host sent them, newest last.
    pub asked: Vec<[f32; 2]>,
}

impl Board {
    fn read(&mut self) -> u8 {
        self.to_board.pop_front().unwrap_or(NOTHING)
    }

    /// Floats are waited for: none when they have not all come.
    fn floats<const N: usize>(&mut self) -> Option<[f32; N]> {
        if self.to_board.len() < 4 * N {
            return None;
        }
        Some(std::array::from_fn(|_| {
            f32::from_le_bytes(std::array::from_fn(|_| self.read()))
        }))
    }

    /// Works off what has come; what it has to wait for it reads another time.
    pub fn work(&mut self) {
        while let Some(command) = self.to_board.front().copied() {
            let before = self.to_board.clone();
            self.to_board.pop_front();
            let done = match command {
                0 => {
                    self.read();
                    self.address = 0;
                    self.resets += 1;
                    true
                }
                1 => self.set_up(),
                2 => self.take_torques(),
                _ => true,
            };
            if !done {
                self.to_board = before;
                return;
            }
        }
    }

    fn set_up(&mut self) -> bool {
        let address = self.read();
        let motors = (self.read() & 3).count_ones();
        (0..motors).for_each(|_| _ = self.read());
        let encoders = (self.read() & 3).count_ones();
        (0..encoders).for_each(|_| _ = self.read());
        for _ in 0..2 {
            (0..self.read()).for_each(|_| _ = self.read());
        }
        self.address = 0;
        if encoders == 2 {
            let Some([first, first_resolution, second, second_resolution]) = self.floats() else {
                return false;
            };
            self.resolution = [first_resolution, second_resolution];
            for (port, offset) in [first, second].into_iter().enumerate() {
                let count = offset * (self.resolution[port] / 2.0) / 360.0;
                self.zero[port] = i64::from(count as i32) - self.counts[port];
            }
            if motors == 2 {
                self.address = address;
            }
        }
        self.setups += 1;
        true
    }

    fn take_torques(&mut self) -> bool {
        let address = self.read();
        // Nobody has address 0 here; on a real board everybody not set up would.
        if address != 0 && address == self.address {
            let Some(torques) = self.floats::<2>() else {
                return false;
            };
            self.torques = torques.map(|torque| {
                let size = torque.abs().min(FULL);
                let duty = (1023.0 * size / FULL) as i32;
                duty as f32 / 1023.0 * FULL * torque.signum()
            });
        }
        if !self.silent {
            self.to_host.push_back(address);
            if address != 0 && address == self.address {
                for port in 0..2 {
                    let count = (self.counts[port] + self.zero[port]) as f64;
                    let half = f64::from(self.resolution[port] / 2.0);
                    let angle = (360.0 * count / half) as f32;
                    self.to_host.extend(angle.to_le_bytes());
                }
            }
        }
        true
    }
}

/// The host's end; clones share the board.
#[derive(Clone, Default)]
pub struct Cable(pub Arc<Mutex<Board>>);

impl Cable {
    pub fn board(&self) -> MutexGuard<'_, Board> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Wire for Cable {
    fn waiting(&mut self) -> io::Result<usize> {
        let board = self.board();
        match board.gone {
            true => Err(io::ErrorKind::BrokenPipe.into()),
            false => Ok(board.to_host.len()),
        }
    }

    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut board = self.board();
        let length = buffer.len().min(board.to_host.len());
        for (byte, arrived) in buffer.iter_mut().zip(board.to_host.drain(..length)) {
            *byte = arrived;
        }
        Ok(length)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut board = self.board();
        if board.full || board.refusals > 0 {
            board.refusals = board.refusals.saturating_sub(1);
            return Err(ErrorKind::WouldBlock.into());
        }
        if bytes.len() == TORQUE_BYTES {
            let float = |at: usize| f32::from_le_bytes(std::array::from_fn(|i| bytes[at + i]));
            if board.asked.len() >= 64 {
                board.asked.drain(..48);
            }
            board.asked.push([float(2), float(6)]);
        }
        board.to_board.extend(bytes);
        Ok(bytes.len())
    }

    fn dismiss(&mut self) {
        self.board().dismissed = true;
    }
}

impl Opener for Cable {
    type Wire = Self;

    fn open(&mut self) -> io::Result<Self> {
        if self.board().gone {
            return Err(ErrorKind::NotFound.into());
        }
        Ok(self.clone())
    }
}
