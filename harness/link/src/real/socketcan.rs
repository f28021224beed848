//! A CAN interface of Linux.

use std::collections::VecDeque;
use std::io::{ErrorKind, IoSliceMut, Write};
use std::os::fd::{AsFd, AsRawFd, BorrowedFd};
use std::path::Path;
use std::time::{Duration, SystemTime};

use fieldproof_can::Frame;
use nix::cmsg_space;
use nix::errno::Errno;
use nix::sys::socket::{
    ControlMessageOwned, MsgFlags, MultiHeaders, RecvMsg, Timestamps, recvmmsg, setsockopt, sockopt,
};
use nix::sys::time::TimeSpec;
use socketcan::{
    CanInterface, CanSocket, SOF_TIMESTAMPING_OPT_CMSG, SOF_TIMESTAMPING_RAW_HARDWARE,
    SOF_TIMESTAMPING_RX_HARDWARE, SOF_TIMESTAMPING_RX_SOFTWARE, SOF_TIMESTAMPING_SOFTWARE, Socket,
    SocketOptions,
};

use super::hardware_clock::HardwareClock;
#[cfg(doc)]
use super::port::SHORT_WAIT;
use super::port::{Departure, News, Port, SendError, down};
use super::raw_frame::{self, FRAME_LENGTH, RawFrame};
use super::{Clock, OpenError};
use crate::{Instant, Line, LinkError, PortProperties, Reception, Sent, Transmission};

/// How many frames are taken from the kernel at once.
const BATCH: usize = 32;

/// How long the kernel is asked to wait for a frame, and for room in its queue; see [`SHORT_WAIT`].
const WAIT_AS_ASKED: Duration = Duration::from_millis(10);

/// How much the kernel may hold for us, in bytes; about a second of a full bus at 1 Mbit/s.
const RECEIVE_BUFFER: usize = 4 << 20;

/// A CAN interface of Linux, through a raw socket. Frames carry the kernel's stamps, or the adapter's where it has them;
/// own frames are stamped when they come back from the driver, which on a real bus is after their acknowledge.
pub struct SocketCan {
    socket: CanSocket,
    interface: CanInterface,
    properties: PortProperties,
    /// Own frames that have not come back yet.
    leaving: VecDeque<Frame>,
    /// How many frames the kernel has dropped by its own count.
    dropped: u32,
    /// If the adapter stamps frames.
    hardware: Option<HardwareClock>,
    /// The instant of the last message.
    last: Instant,
}

impl SocketCan {
    /// Opens the interface called `name` for `role`, whose bus is said to run at `bit_rate` bits a second. Without
    /// `uncertainty`, what is known of the adapter decides how far an instant may be off.
    ///
    /// # Errors
    /// [`OpenError`]: there is no such interface, it is down, or it is set to another bit rate.
    pub fn open(
        role: &str,
        name: &str,
        bit_rate: u32,
        uncertainty: Option<Duration>,
    ) -> Result<SocketCan, OpenError> {
        let link = format!("socketcan:{name}");
        let wrong = |reason: String| OpenError::new(&link, reason);
        let interface = CanInterface::open(name).map_err(|error| match error {
            Errno::ENODEV => wrong(format!("there is no interface {name}")),
            _ => wrong(error.to_string()),
        })?;
        if !is_up(name) {
            return Err(wrong(format!(
                "the interface is down; `ip link set {name} up` brings it up"
            )));
        }
        let real_bit_rate = interface.bit_rate().ok().flatten();
        if let Some(real) = real_bit_rate
            && real != bit_rate
        {
            return Err(wrong(format!(
                "the interface is set to {real} bit/s and the device to {bit_rate} bit/s; \
                 `ip link set {name} down && ip link set {name} up type can bitrate {bit_rate}` sets it"
            )));
        }
        let socket = CanSocket::open(name).map_err(|error| wrong(error.to_string()))?;
        let has_hardware_stamps = socket.has_hw_timestamps();
        set_options(&socket, has_hardware_stamps).map_err(|error| wrong(error.to_string()))?;
        Ok(SocketCan {
            properties: PortProperties {
                name: role.to_owned(),
                line: Line::Can { bit_rate },
                timestamps: match has_hardware_stamps {
                    true => "hardware",
                    false => "kernel",
                },
                uncertainty: uncertainty.unwrap_or_else(|| match has_hardware_stamps {
                    true => Duration::from_micros(10),
                    false => stamping_uncertainty(name),
                }),
                sets_bit_rate: real_bit_rate.is_some(),
                tells_departure: true,
                link,
            },
            socket,
            interface,
            leaving: VecDeque::new(),
            dropped: 0,
            hardware: has_hardware_stamps.then(HardwareClock::default),
            last: Instant::START,
        })
    }

    /// What the interface called `name` is set to, in bits a second, if there is one and it has a bit rate.
    pub fn bit_rate_of(name: &str) -> Option<u32> {
        CanInterface::open(name).ok()?.bit_rate().ok().flatten()
    }

    /// Takes up to `count` messages; how many.
    fn take_batch(
        &mut self,
        count: usize,
        flags: MsgFlags,
        clock: &mut Clock,
        news: &mut Vec<News>,
    ) -> Result<usize, LinkError> {
        let mut buffers = [[0; FRAME_LENGTH]; BATCH];
        let mut slices = buffers.each_mut().map(|it| [IoSliceMut::new(it)]);
        let ancillary = cmsg_space!(TimeSpec, [TimeSpec; 3], u32);
        // Not kept for the next time: the kernel shortens the room in them to what it has used.
        let mut headers = MultiHeaders::<()>::preallocate(count, Some(ancillary));
        let room = slices.iter_mut().take(count);
        let received = match recvmmsg(self.socket.as_raw_fd(), &mut headers, room, flags, None) {
            Ok(received) => received,
            Err(Errno::EAGAIN | Errno::EINTR) => return Ok(0),
            Err(error) => return Err(down(&self.properties, error)),
        };
        let mut taken = 0;
        for message in received {
            news.extend(self.news(&Message::read(&message), clock)?);
            taken += 1;
        }
        Ok(taken)
    }

    /// One message of the socket.
    fn news(&mut self, message: &Message, clock: &mut Clock) -> Result<Option<News>, LinkError> {
        let at = self.instant(message, clock);
        if message.dropped != self.dropped {
            let lost = message.dropped.wrapping_sub(self.dropped);
            self.dropped = message.dropped;
            return Err(self.overflow(lost));
        }
        Ok(match raw_frame::decode(&message.bytes) {
            RawFrame::Frame(frame) if self.leaving.front() == Some(&frame) => {
                self.leaving.pop_front();
                Some(News::Left(self.sent(frame, at)))
            }
            RawFrame::Frame(frame) => {
                let what = Reception::Frame(frame);
                Some(News::Arrived { at, what })
            }
            RawFrame::Error(error) if error.is_receive_overflow() => {
                return Err(self.overflow(1));
            }
            RawFrame::Error(error) => {
                let what = Reception::BusError(error);
                Some(News::Arrived { at, what })
            }
            // A CAN FD frame on an interface that carries both: nothing of ours.
            RawFrame::Other => None,
        })
    }

    fn overflow(&self, lost: u32) -> LinkError {
        LinkError::Overflow {
            port: self.properties.name.clone(),
            lost,
        }
    }

    /// The stamp is that of the frame's end.
    fn sent(&self, frame: Frame, end: Instant) -> Sent {
        let length = match self.properties.line {
            Line::Can { bit_rate } if self.properties.sets_bit_rate => {
                Duration::from_nanos(crate::signal::bits_in_nanos(frame.bits().into(), bit_rate))
            }
            // A bus without bits.
            _ => Duration::ZERO,
        };
        Sent {
            start: end - length,
            end,
        }
    }

    fn instant(&mut self, message: &Message, clock: &mut Clock) -> Instant {
        let arrived = match message.kernel_stamp {
            Some(stamp) => clock.at(stamp),
            None => clock.now(),
        };
        let at = match (&mut self.hardware, message.hardware_stamp) {
            (Some(hardware), Some(stamp)) => hardware.at(stamp, arrived),
            _ => arrived,
        };
        // Where the clocks were compared between two messages, the second may seem to be the earlier by a little.
        self.last = self.last.max(at);
        self.last
    }
}

impl Port for SocketCan {
    fn properties(&self) -> &PortProperties {
        &self.properties
    }

    fn readable(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }

    fn send(&mut self, _: &mut Clock, what: &Transmission) -> Result<Departure, SendError> {
        let Transmission::Frame(frame) = what else {
            let port = self.properties.name.clone();
            return Err(LinkError::WrongKind { port }.into());
        };
        match self.socket.write(&raw_frame::encode(frame)) {
            Ok(_) => {
                self.leaving.push_back(*frame);
                Ok(Departure::Told)
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => Err(SendError::Busy),
            Err(error) if error.raw_os_error() == Some(Errno::ENOBUFS as i32) => {
                Err(SendError::Busy)
            }
            Err(error) => Err(down(&self.properties, error).into()),
        }
    }

    fn take(&mut self, clock: &mut Clock, news: &mut Vec<News>) -> Result<(), LinkError> {
        while self.take_batch(BATCH, MsgFlags::MSG_DONTWAIT, clock, news)? == BATCH {}
        Ok(())
    }

    /// While frames are leaving, the system call is asked to wait for them and one more: on an idle bus they are back
    /// before the answer is there. Else it waits for one, and takes all that are there: a full bus leaves no time for a
    /// call for each.
    fn take_waiting(
        &mut self,
        clock: &mut Clock,
        news: &mut Vec<News>,
    ) -> Option<Result<(), LinkError>> {
        let (count, flags) = match self.leaving.len() {
            0 => (BATCH, MsgFlags::MSG_WAITFORONE),
            leaving => ((leaving + 1).min(BATCH), MsgFlags::empty()),
        };
        let taken = self.take_batch(count, flags, clock, news);
        Some(taken.map(|_| ()))
    }

    fn set_line(&mut self, line: Line) -> Result<(), LinkError> {
        let Line::Can { bit_rate } = line else {
            let port = self.properties.name.clone();
            return Err(LinkError::WrongKind { port });
        };
        if !self.properties.sets_bit_rate {
            return Err(down(&self.properties, "this interface has no bit rate"));
        }
        let interface = &self.interface;
        interface
            .bring_down()
            .and_then(|()| interface.set_bitrate(bit_rate, None))
            .and_then(|()| interface.bring_up())
            .map_err(|error| down(&self.properties, format!("setting the bit rate: {error}")))?;
        self.leaving.clear();
        self.properties.line = line;
        Ok(())
    }
}

fn set_options(
    socket: &CanSocket,
    hardware_stamps: bool,
) -> Result<(), Box<dyn std::error::Error>> {
    socket.set_read_timeout(WAIT_AS_ASKED)?;
    socket.set_write_timeout(WAIT_AS_ASKED)?;
    socket.set_recv_own_msgs(true)?;
    socket.set_error_filter_accept_all()?;
    if hardware_stamps {
        socket.set_timestamping(
            SOF_TIMESTAMPING_RX_HARDWARE
                | SOF_TIMESTAMPING_RAW_HARDWARE
                | SOF_TIMESTAMPING_RX_SOFTWARE
                | SOF_TIMESTAMPING_SOFTWARE
                | SOF_TIMESTAMPING_OPT_CMSG,
        )?;
    } else {
        socket.set_recv_timestamp(true)?;
    }
    setsockopt(socket, sockopt::RxqOvfl, &1)?;
    // Forced where that is permitted; else as much as the system allows.
    setsockopt(socket, sockopt::RcvBufForce, &RECEIVE_BUFFER)
        .or_else(|_| setsockopt(socket, sockopt::RcvBuf, &RECEIVE_BUFFER))?;
    Ok(())
}

fn is_up(interface: &str) -> bool {
    const IFF_UP: u32 = 1;
    let flags = std::fs::read_to_string(format!("/sys/class/net/{interface}/flags"));
    // Where it cannot be read, sending will tell.
    flags.map_or(true, |flags| {
        let hex = flags.trim().trim_start_matches("0x");
        u32::from_str_radix(hex, 16).is_ok_and(|flags| flags & IFF_UP != 0)
    })
}

/// How late the kernel may stamp: a USB adapter hands frames over once a millisecond.
fn stamping_uncertainty(interface: &str) -> Duration {
    let device = Path::new("/sys/class/net").join(interface).join("device");
    match std::fs::read_link(device.join("subsystem")) {
        Ok(bus) if bus.ends_with("usb") => Duration::from_millis(1),
        Ok(_) => Duration::from_micros(200),
        Err(_) => Duration::from_micros(100),
    }
}

/// One message of the socket, as the kernel gives it.
struct Message {
    bytes: [u8; FRAME_LENGTH],
    kernel_stamp: Option<SystemTime>,
    hardware_stamp: Option<Duration>,
    /// The kernel's count of dropped frames; 0 until one was.
    dropped: u32,
}

impl Message {
    fn read(received: &RecvMsg<'_, '_, ()>) -> Message {
        let mut message = Message {
            bytes: [0; FRAME_LENGTH],
            kernel_stamp: None,
            hardware_stamp: None,
            dropped: 0,
        };
        for (place, byte) in message.bytes.iter_mut().zip(received.iovs().flatten()) {
            *place = *byte;
        }
        for part in received.cmsgs().into_iter().flatten() {
            message.read_ancillary(part);
        }
        message
    }

    fn read_ancillary(&mut self, part: ControlMessageOwned) {
        match part {
            ControlMessageOwned::ScmTimestampns(stamp) => {
                self.kernel_stamp = Some(SystemTime::UNIX_EPOCH + Duration::from(stamp));
            }
            ControlMessageOwned::ScmTimestampsns(Timestamps { system, hw_raw, .. }) => {
                let system = Duration::from(system);
                self.kernel_stamp = (!system.is_zero()).then(|| SystemTime::UNIX_EPOCH + system);
                let hardware = Duration::from(hw_raw);
                self.hardware_stamp = (!hardware.is_zero()).then_some(hardware);
            }
            ControlMessageOwned::RxqOvfl(dropped) => self.dropped = dropped,
            _ => {}
        }
    }
}
