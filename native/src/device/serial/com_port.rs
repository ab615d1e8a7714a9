//! A COM port of Windows, by overlapped calls: a call that has to wait goes on without its caller.

use std::fmt;
use std::io::{self, ErrorKind};
use std::os::windows::io::{AsRawHandle, FromRawHandle, OwnedHandle, RawHandle};
use std::ptr::{null, null_mut};

use windows_sys::Win32::Devices::Communication::{
    COMMTIMEOUTS, COMSTAT, ClearCommError, DCB, GetCommState, NOPARITY, ONESTOPBIT, SetCommState,
    SetCommTimeouts,
};
use windows_sys::Win32::Foundation::{
    ERROR_IO_INCOMPLETE, ERROR_IO_PENDING, ERROR_OPERATION_ABORTED, GENERIC_READ, GENERIC_WRITE,
    INVALID_HANDLE_VALUE,
};
use windows_sys::Win32::Storage::FileSystem::{
    CreateFileW, FILE_FLAG_OVERLAPPED, OPEN_EXISTING, ReadFile, WriteFile,
};
use windows_sys::Win32::System::IO::{CancelIoEx, GetOverlappedResult, OVERLAPPED};
use windows_sys::Win32::System::Threading::CreateEventW;

use crate::device::serial::twin::Twin;
use crate::device::serial::wire::{TwinnedWire, Wire};

/// Most bytes of one write.
const MOST: usize = 64;
/// Of a `DCB`: bytes as they are, DTR and RTS raised for as long as the port is open, as Linux does
/// it: boards with USB of their own send nothing before.
const RAW: u32 = 1 | 1 << 4 | 1 << 12;

/// An open COM port, read and written without waiting.
#[derive(Debug)]
pub struct ComPort {
    /// Before the port: the driver lets go of their memory first.
    reading: Call,
    writing: Call,
    /// What is being written, where the driver finds it.
    outbox: Box<[u8; MOST]>,
    outbox_to: usize,
    port: Port,
    baud: Option<u32>,
}

impl ComPort {
    pub(super) fn open(path: &str, baud: u32, is_its_own: bool) -> io::Result<Self> {
        // Names above COM9 are known in this form only.
        let name = if path.starts_with('\\') {
            path.to_owned()
        } else {
            format!(r"\\.\{path}")
        };
        let name: Vec<u16> = name.encode_utf16().chain([0]).collect();
        let access = GENERIC_READ | GENERIC_WRITE;
        // SAFETY: the name ends with a zero; what is returned is a new handle or none.
        let port = unsafe {
            let handle = CreateFileW(
                name.as_ptr(),
                access,
                0,
                null(),
                OPEN_EXISTING,
                FILE_FLAG_OVERLAPPED,
                null_mut(),
            );
            if handle == INVALID_HANDLE_VALUE {
                return Err(io::Error::last_os_error());
            }
            Port(OwnedHandle::from_raw_handle(handle))
        };
        port.set_up(baud)?;
        Ok(Self {
            reading: Call::on(&port)?,
            writing: Call::on(&port)?,
            outbox: Box::new([0; MOST]),
            outbox_to: 0,
            port,
            baud: is_its_own.then_some(baud),
        })
    }
}

impl TwinnedWire for ComPort {
    fn twin(&self) -> io::Result<Twin> {
        Ok(Twin::Serial(self.port.again()?.0))
    }
}

impl Wire for ComPort {
    fn waiting(&mut self) -> io::Result<usize> {
        Ok(self.port.queues()?.cbInQue as usize)
    }

    /// Bytes of a write under way count until all of it is done: how many of them have left is not told.
    fn queued(&mut self) -> usize {
        let ours = match self.writing.outcome(false) {
            Ok(None) => self.outbox_to,
            _ => 0,
        };
        let drivers = self
            .port
            .queues()
            .map_or(0, |found| found.cbOutQue as usize);
        drivers.max(ours)
    }

    fn bits_per_second(&self) -> Option<u32> {
        self.baud
    }

    /// Comes back at once, with what there is: so the port's time limits say.
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let (at, length) = (buffer.as_mut_ptr(), buffer.len() as u32);
        // SAFETY: the buffer is valid for writing until the call is over, which is waited for.
        self.reading.begin(|port, overlapped| unsafe {
            ReadFile(port, at, length, null_mut(), overlapped)
        })?;
        match self.reading.outcome(true)? {
            Some(count) if count > 0 => Ok(count),
            _ => Err(ErrorKind::WouldBlock.into()),
        }
    }

    /// Takes one message at a time: the next one when the driver is done with it.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.writing.outcome(false)?.is_none() {
            return Err(ErrorKind::WouldBlock.into());
        }
        let count = bytes.len().min(MOST);
        self.outbox[..count].copy_from_slice(&bytes[..count]);
        self.outbox_to = count;
        let at = self.outbox.as_ptr();
        // SAFETY: the outbox stays where it is and as it is until the call is over, or cancelled
        // when this is dropped.
        self.writing.begin(|port, overlapped| unsafe {
            WriteFile(port, at, count as u32, null_mut(), overlapped)
        })?;
        Ok(count)
    }
}

/// The handle of an open COM port.
#[derive(Debug)]
struct Port(OwnedHandle);

impl Port {
    fn set_up(&self, baud: u32) -> io::Result<()> {
        let limits = COMMTIMEOUTS {
            // A read takes what there is; a write has no limit, as nobody waits for it.
            ReadIntervalTimeout: u32::MAX,
            ..COMMTIMEOUTS::default()
        };
        let mut line = DCB {
            DCBlength: size_of::<DCB>() as u32,
            ..DCB::default()
        };
        let handle = self.as_raw_handle();
        // SAFETY: the port is open; the settings are valid for reading and writing.
        let done = unsafe {
            GetCommState(handle, &raw mut line) != 0 && {
                line.BaudRate = baud;
                line._bitfield = RAW;
                (line.ByteSize, line.Parity, line.StopBits) = (8, NOPARITY, ONESTOPBIT);
                SetCommState(handle, &raw const line) != 0
                    && SetCommTimeouts(handle, &raw const limits) != 0
            }
        };
        done.then_some(()).ok_or_else(io::Error::last_os_error)
    }

    fn queues(&self) -> io::Result<COMSTAT> {
        let (mut errors, mut found) = (0, COMSTAT::default());
        // SAFETY: the port is open; both are valid for writing.
        match unsafe { ClearCommError(self.as_raw_handle(), &raw mut errors, &raw mut found) } {
            0 => Err(io::Error::last_os_error()),
            _ => Ok(found),
        }
    }

    fn again(&self) -> io::Result<Self> {
        Ok(Self(self.0.try_clone()?))
    }
}

impl AsRawHandle for Port {
    fn as_raw_handle(&self) -> RawHandle {
        self.0.as_raw_handle()
    }
}

/// One call at a time that the driver carries out while its caller goes on.
struct Call {
    overlapped: Box<OVERLAPPED>,
    /// Closed after the last call is over.
    _done: OwnedHandle,
    port: Port,
    is_under_way: bool,
}

// SAFETY: the event is the system's, and what the driver writes to belongs to this alone.
unsafe impl Send for Call {}

impl fmt::Debug for Call {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "Call {{ is_under_way: {} }}", self.is_under_way)
    }
}

impl Call {
    fn on(port: &Port) -> io::Result<Self> {
        // SAFETY: no attributes and no name are passed; what is returned is a new handle or none.
        let done = unsafe {
            let event = CreateEventW(null(), 1, 0, null());
            if event.is_null() {
                return Err(io::Error::last_os_error());
            }
            OwnedHandle::from_raw_handle(event)
        };
        let mut overlapped = Box::new(OVERLAPPED::default());
        overlapped.hEvent = done.as_raw_handle();
        Ok(Self {
            overlapped,
            _done: done,
            port: port.again()?,
            is_under_way: false,
        })
    }

    fn begin(&mut self, start: impl FnOnce(RawHandle, *mut OVERLAPPED) -> i32) -> io::Result<()> {
        if start(self.port.as_raw_handle(), &raw mut *self.overlapped) == 0 {
            let error = io::Error::last_os_error();
            if error.raw_os_error() != Some(ERROR_IO_PENDING as i32) {
                return Err(error);
            }
        }
        self.is_under_way = true;
        Ok(())
    }

    /// Bytes that the last call carried, none where it was ended before; None while it is under way.
    fn outcome(&mut self, is_waited_for: bool) -> io::Result<Option<usize>> {
        if !self.is_under_way {
            return Ok(Some(0));
        }
        let mut count = 0;
        // SAFETY: the call was begun on this port with this memory, and the count is valid for writing.
        let is_over = unsafe {
            GetOverlappedResult(
                self.port.as_raw_handle(),
                &raw const *self.overlapped,
                &raw mut count,
                i32::from(is_waited_for),
            )
        };
        if is_over != 0 {
            self.is_under_way = false;
            return Ok(Some(count as usize));
        }
        let error = io::Error::last_os_error();
        match error.raw_os_error().map(|number| number as u32) {
            Some(ERROR_IO_INCOMPLETE) => Ok(None),
            Some(ERROR_OPERATION_ABORTED) => {
                self.is_under_way = false;
                Ok(Some(0))
            }
            _ => {
                self.is_under_way = false;
                Err(error)
            }
        }
    }
}

impl Drop for Call {
    /// The driver must be done with the memory before it goes.
    fn drop(&mut self) {
        if self.is_under_way {
            // SAFETY: the call was begun on this port with this memory.
            unsafe { CancelIoEx(self.port.as_raw_handle(), &raw const *self.overlapped) };
            let _ = self.outcome(true);
        }
    }
}
