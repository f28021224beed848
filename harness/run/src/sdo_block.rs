//! The SDO client's block transfers: every number, size and CRC of the server checked.

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_link::Instant;
use fieldproof_suite::model::{BlockMistake, BlockTransfer};
use fieldproof_wire::canopen::sdo::{
    BlockSegment, BlockSize, Request, Response, SegmentNumber, UnusedBytes, block_crc,
};
use fieldproof_wire::canopen::{Multiplexer, Service};

use crate::sdo::{
    LONGEST_VALUE, Outcome, Protocol, Uploaded, check_object, malformed, read_response, refused,
    wrong_service,
};
use crate::session::{Message, Received};
use crate::stop::{Came, Stop};
use crate::tester::Tester;

/// How a block transfer ended.
#[derive(Debug)]
pub(crate) enum Ended<T> {
    /// The server carried it out or refused it.
    With(Outcome<T>),
    /// The tester gave it up, as the step says.
    GivenUp,
}

const BLOCK_TIME: &str = "SDO block response time";
const SEGMENT: usize = 7;
/// A segment number that there is not.
const NO_SUCH_SEGMENT: u8 = 128;
/// How often in a row a server may ask for segments again before it does not get on.
const MOST_REPEATS: u32 = 8;

/// What both sides agreed on when an upload began.
#[derive(Clone, Copy)]
struct Agreed {
    crc: bool,
    /// The size that the server gave.
    size: Option<u32>,
}

/// A block of an upload as it came.
struct Block {
    data: Vec<u8>,
    /// How many segments it had.
    count: u8,
    /// The last of them was the last of the transfer.
    last: bool,
    ended_at: Instant,
}

impl Tester<'_> {
    /// Reads an object in blocks.
    pub(crate) fn sdo_block_upload(
        &mut self,
        object: Multiplexer,
        block: &BlockTransfer,
        within: Duration,
    ) -> Result<Ended<Uploaded>, Stop> {
        let initiate = Request::InitiateBlockUpload {
            object,
            crc: block.crc,
            block_size: BlockSize::MAX,
            switch_threshold: block.switch_threshold,
        };
        let mut bytes = initiate.encode();
        bytes[4] = block.block_size;
        let agreed = match self.sdo_exchange_bytes(bytes, within)? {
            Response::Abort {
                object: named,
                code,
            } => return refused(object, named, code).map(Ended::With),
            Response::InitiateBlockUpload {
                object: named,
                crc,
                size,
            } => {
                check_object("the answer to the read", object, named)?;
                Agreed {
                    crc: crc && block.crc,
                    size,
                }
            }
            Response::InitiateUpload {
                object: named,
                transfer,
            } if block.switch_threshold > 0 => {
                check_object("the answer to the read", object, named)?;
                let outcome = self.finish_upload(object, transfer, within)?;
                return check_switched(&outcome, block.switch_threshold)
                    .map(|()| Ended::With(outcome));
            }
            other => return Err(wrong_service("an answer to initiate block upload", &other)),
        };
        self.open_transfer = Some(object);
        let ended = self.upload_blocks(object, block, agreed, within)?;
        if !matches!(ended, Ended::GivenUp) {
            self.open_transfer = None;
        }
        Ok(ended)
    }

    fn upload_blocks(
        &mut self,
        object: Multiplexer,
        block: &BlockTransfer,
        agreed: Agreed,
        within: Duration,
    ) -> Result<Ended<Uploaded>, Stop> {
        let mut value = Vec::new();
        let mut mistake = block.mistake;
        let mut block_size = block.block_size;
        self.send_sdo(Request::StartBlockUpload.encode())?;
        loop {
            let came = match self.receive_block(object, block_size, within)? {
                Outcome::Done(came) => came,
                Outcome::Refused(code) => return Ok(Ended::With(Outcome::Refused(code))),
            };
            let in_this = block_size;
            block_size = block.next_block_size.unwrap_or(block_size);
            let mut acknowledged = came.count;
            match mistake.take() {
                Some(BlockMistake::Abandon) => return Ok(Ended::GivenUp),
                Some(BlockMistake::Abort) => {
                    self.abort_open_transfer()?;
                    return Ok(Ended::GivenUp);
                }
                Some(BlockMistake::WrongNumber) => {
                    return self.acknowledge_too_many(object, block_size, within);
                }
                Some(BlockMistake::LostSegment) => acknowledged /= 2,
                Some(BlockMistake::WrongCrc | BlockMistake::WrongSize) | None => {}
            }
            let taken = usize::from(acknowledged) * SEGMENT;
            value.extend(came.data.into_iter().take(taken));
            if value.len() > LONGEST_VALUE {
                return Err(does_not_end());
            }
            let acknowledge = acknowledge(acknowledged, block_size);
            if came.last && acknowledged == came.count {
                let outcome = self.end_upload(object, acknowledge, value, agreed, within)?;
                return Ok(Ended::With(outcome));
            }
            self.send_sdo(acknowledge)?;
            self.check_nothing_beyond(came.ended_at, in_this)?;
        }
    }

    /// The tester acknowledges at once, so that what lies before its acknowledge was sent without one.
    fn check_nothing_beyond(&self, block_ended_at: Instant, block_size: u8) -> Result<(), Stop> {
        let id = Id::Standard(self.identifier(Service::SdoResponse)?);
        let acknowledged_at = self.session.last_sent().end;
        let beyond = self.session.count(|received| {
            received.at > block_ended_at
                && received.at < acknowledged_at
                && matches!(received.message, Message::Can(frame) if frame.id() == id)
        });
        match beyond {
            0 => Ok(()),
            _ => Err(Stop::mismatch(
                format!("the server goes on beyond the block size of {block_size}"),
                "nothing more until the acknowledge",
                "another segment",
                Came::Other,
            )),
        }
    }

    /// Receives the segments of a block.
    fn receive_block(
        &mut self,
        object: Multiplexer,
        block_size: u8,
        within: Duration,
    ) -> Result<Outcome<Block>, Stop> {
        let most = BlockSize::new(block_size).unwrap_or(BlockSize::MAX).raw();
        let mut block = Block {
            data: Vec::with_capacity(usize::from(most) * SEGMENT),
            count: 0,
            last: false,
            ended_at: self.session.last_sent().end,
        };
        let mut since = self.session.last_sent().end;
        while block.count < most && !block.last {
            let number = block.count + 1;
            let deadline = since.max(self.session.last_sent().end) + within;
            let Some((frame, received)) = self.next_answer(deadline)? else {
                return Err(Stop::mismatch(
                    "the SDO server stops within a block",
                    format!("segment {number} within {}", crate::limits::show(within)),
                    "nothing",
                    Came::Silence,
                ));
            };
            self.watch.confirmed(received.at);
            if block.count == 0 {
                self.measure_response(BLOCK_TIME, &received, within)?;
            }
            since = received.at;
            let segment = match frame.bytes() {
                [0x80, ..] => return self.refused_within_block(object, &frame),
                bytes => BlockSegment::parse(bytes).map_err(|violation| {
                    malformed(
                        &frame,
                        violation.expected,
                        format!("{} ({frame})", violation.found),
                    )
                })?,
            };
            if segment.number.raw() != number {
                return Err(Stop::differs(
                    "the segments of the block are not in order",
                    format!("segment {number}"),
                    format!("segment {} ({frame})", segment.number.raw()),
                    Came::Frame(frame),
                ));
            }
            block.data.extend(segment.data);
            block.count = number;
            block.last = segment.last;
            block.ended_at = received.at;
        }
        Ok(Outcome::Done(block))
    }

    fn refused_within_block(
        &mut self,
        object: Multiplexer,
        frame: &Frame,
    ) -> Result<Outcome<Block>, Stop> {
        match read_response(frame)? {
            Response::Abort {
                object: named,
                code,
            } => refused(object, named, code),
            other => Err(wrong_service("a segment of the block", &other)),
        }
    }

    /// Acknowledges a segment that there is not, which the server must refuse.
    fn acknowledge_too_many(
        &mut self,
        object: Multiplexer,
        block_size: u8,
        within: Duration,
    ) -> Result<Ended<Uploaded>, Stop> {
        let acknowledge = acknowledge(NO_SUCH_SEGMENT, block_size);
        match self.sdo_exchange_bytes(acknowledge, within)? {
            Response::Abort {
                object: named,
                code,
            } => refused(object, named, code).map(Ended::With),
            other => Err(wrong_service("an abort of the transfer", &other)
                .with_note(format!("segment {NO_SUCH_SEGMENT} was acknowledged"))),
        }
    }

    /// Acknowledges the last block and checks the end that the server sends.
    fn end_upload(
        &mut self,
        object: Multiplexer,
        acknowledge: [u8; 8],
        mut value: Vec<u8>,
        agreed: Agreed,
        within: Duration,
    ) -> Result<Outcome<Uploaded>, Stop> {
        let (unused, crc) = match self.sdo_exchange_bytes(acknowledge, within)? {
            Response::Abort {
                object: named,
                code,
            } => return refused(object, named, code),
            Response::EndBlockUpload { unused, crc } => (unused, crc),
            other => return Err(wrong_service("the end of the block upload", &other)),
        };
        value.truncate(value.len().saturating_sub(usize::from(unused.raw())));
        if let Some(size) = agreed.size
            && size as usize != value.len()
        {
            return Err(Stop::differs(
                "the blocks do not carry as many bytes as the server announced",
                format!("{size} bytes"),
                format!("{} bytes", value.len()),
                Came::Other,
            )
            .with_note(format!(
                "{} bytes of the last segment are without data, it says",
                unused.raw()
            )));
        }
        let (expected, what) = match agreed.crc {
            true => (block_crc(&value), "the CRC of the upload is wrong"),
            false => (0, "the upload has a CRC that was not agreed on"),
        };
        if crc != expected {
            return Err(Stop::differs(
                what,
                format!("{expected:04X}h"),
                format!("{crc:04X}h"),
                Came::Other,
            ));
        }
        self.send_sdo(Request::EndBlockUpload.encode())?;
        Ok(Outcome::Done(Uploaded::sized(value, Protocol::Block)))
    }

    /// Writes an object in blocks.
    pub(crate) fn sdo_block_download(
        &mut self,
        object: Multiplexer,
        value: &[u8],
        block: &BlockTransfer,
        within: Duration,
    ) -> Result<Ended<()>, Stop> {
        let surplus = u32::from(block.mistake == Some(BlockMistake::WrongSize));
        let initiate = Request::InitiateBlockDownload {
            object,
            crc: block.crc,
            size: block.size_given.then_some(value.len() as u32 + surplus),
        };
        let (crc, block_size) = match self.sdo_exchange_bytes(initiate.encode(), within)? {
            Response::Abort {
                object: named,
                code,
            } => return refused(object, named, code).map(Ended::With),
            Response::InitiateBlockDownload {
                object: named,
                crc,
                block_size,
            } => {
                check_object("the answer to the write", object, named)?;
                (crc && block.crc, block_size)
            }
            other => {
                return Err(wrong_service(
                    "an answer to initiate block download",
                    &other,
                ));
            }
        };
        self.open_transfer = Some(object);
        if block.mistake == Some(BlockMistake::WrongCrc) && !crc {
            return Err(no_occasion("makes no use of a CRC"));
        }
        let mut download = Download {
            object,
            value,
            mistake: block.mistake,
            offset: 0,
            repeats: 0,
        };
        let ended = match self.download_blocks(&mut download, block_size, within)? {
            Ended::With(Outcome::Done(unused)) => {
                let wrong = u16::from(block.mistake == Some(BlockMistake::WrongCrc));
                let right = if crc { block_crc(value) } else { 0 };
                self.watch.wrote(object, value);
                self.end_download(object, unused, right ^ wrong, within)?
            }
            Ended::With(Outcome::Refused(code)) => Ended::With(Outcome::Refused(code)),
            Ended::GivenUp => return Ok(Ended::GivenUp),
        };
        self.open_transfer = None;
        Ok(ended)
    }

    /// Sends all blocks; gives how many bytes of the last segment are not data.
    fn download_blocks(
        &mut self,
        download: &mut Download<'_>,
        mut block_size: BlockSize,
        within: Duration,
    ) -> Result<Ended<UnusedBytes>, Stop> {
        loop {
            let segments = download.segments(block_size);
            let lost = match download.mistake.take() {
                Some(BlockMistake::Abort) => {
                    self.send_segments(&segments[..1], None)?;
                    self.abort_open_transfer()?;
                    return Ok(Ended::GivenUp);
                }
                Some(BlockMistake::LostSegment) if segments.len() < 2 => {
                    return Err(no_occasion("takes one segment a block"));
                }
                Some(BlockMistake::LostSegment) => Some(segments.len() - 2),
                // To be made after the last block.
                Some(BlockMistake::Abandon) => {
                    download.mistake = Some(BlockMistake::Abandon);
                    None
                }
                Some(
                    BlockMistake::WrongCrc | BlockMistake::WrongSize | BlockMistake::WrongNumber,
                )
                | None => None,
            };
            self.send_segments(&segments, lost)?;
            let in_order = lost.unwrap_or(segments.len());
            let (acknowledged, next) = match self.block_acknowledged(download.object, within)? {
                Outcome::Done(answer) => answer,
                Outcome::Refused(code) => return Ok(Ended::With(Outcome::Refused(code))),
            };
            block_size = next;
            let acknowledged = acknowledged.map_or(0, SegmentNumber::raw);
            download.check_acknowledged(usize::from(acknowledged), in_order, lost.is_some())?;
            if usize::from(acknowledged) < in_order {
                self.notes.push(format!(
                    "the server took {acknowledged} of {in_order} segments and had the others sent again"
                ));
            }
            download.offset += usize::from(acknowledged) * SEGMENT;
            let ended = segments.last().is_some_and(|segment| segment.last);
            if ended && usize::from(acknowledged) == segments.len() {
                return Ok(match download.mistake {
                    Some(_) => Ended::GivenUp,
                    None => Ended::With(Outcome::Done(download.unused())),
                });
            }
        }
    }

    fn send_segments(
        &mut self,
        segments: &[BlockSegment],
        lost: Option<usize>,
    ) -> Result<(), Stop> {
        let sent = segments.iter().enumerate();
        sent.filter(|(place, _)| Some(*place) != lost)
            .try_for_each(|(_, segment)| self.send_sdo(segment.encode()))
    }

    fn block_acknowledged(
        &mut self,
        object: Multiplexer,
        within: Duration,
    ) -> Result<Outcome<(Option<SegmentNumber>, BlockSize)>, Stop> {
        match self.sdo_answer(BLOCK_TIME, within)? {
            Response::Abort {
                object: named,
                code,
            } => refused(object, named, code),
            Response::AcknowledgeBlockDownload {
                acknowledged,
                block_size,
            } => Ok(Outcome::Done((acknowledged, block_size))),
            other => Err(wrong_service("an acknowledge of the block", &other)),
        }
    }

    fn end_download(
        &mut self,
        object: Multiplexer,
        unused: UnusedBytes,
        crc: u16,
        within: Duration,
    ) -> Result<Ended<()>, Stop> {
        let end = Request::EndBlockDownload { unused, crc };
        match self.sdo_exchange_bytes(end.encode(), within)? {
            Response::Abort {
                object: named,
                code,
            } => refused(object, named, code).map(Ended::With),
            Response::EndBlockDownload => Ok(Ended::With(Outcome::Done(()))),
            other => Err(wrong_service(
                "an answer to the end of the block download",
                &other,
            )),
        }
    }

    /// The next answer of the SDO server, until `deadline`.
    fn next_answer(
        &mut self,
        deadline: fieldproof_link::Instant,
    ) -> Result<Option<(Frame, Received)>, Stop> {
        let port = self.can_port()?;
        let id = Id::Standard(self.identifier(Service::SdoResponse)?);
        let deadline = deadline + self.session.uncertainty(port);
        let wanted = |received: &Received| {
            received.port == port
                && matches!(received.message, Message::Can(frame) if frame.id() == id)
        };
        let found = self.session.first(deadline, wanted)?;
        Ok(found.and_then(|received| match received.message {
            Message::Can(frame) => Some((frame, received)),
            Message::Serial { .. } => None,
        }))
    }
}

/// A block download on its way.
struct Download<'v> {
    object: Multiplexer,
    value: &'v [u8],
    /// What is still to be done wrong.
    mistake: Option<BlockMistake>,
    /// Bytes that the server has.
    offset: usize,
    /// How often in a row the server asked for segments again.
    repeats: u32,
}

impl Download<'_> {
    /// The segments of the next block; at least one.
    fn segments(&self, block_size: BlockSize) -> Vec<BlockSegment> {
        let rest = self.value.get(self.offset..).unwrap_or_default();
        let count = rest.len().div_ceil(SEGMENT).max(1);
        let numbers = (1..=block_size.raw()).filter_map(SegmentNumber::new);
        let segment = |(place, number): (usize, SegmentNumber)| {
            let mut data = [0; SEGMENT];
            let part = rest.get(place * SEGMENT..).unwrap_or_default();
            data.iter_mut().zip(part).for_each(|(to, from)| *to = *from);
            BlockSegment {
                last: place + 1 == count,
                number,
                data,
            }
        };
        (0..count).zip(numbers).map(segment).collect()
    }

    /// How many bytes of the last segment are not data.
    fn unused(&self) -> UnusedBytes {
        let filled = match self.value.len() {
            0 => 0,
            size => (size - 1) % SEGMENT + 1,
        };
        UnusedBytes::new((SEGMENT - filled) as u8).unwrap_or(UnusedBytes::MIN)
    }

    /// Whether the server acknowledges no more than came in order, and gets on.
    fn check_acknowledged(
        &mut self,
        acknowledged: usize,
        in_order: usize,
        one_was_lost: bool,
    ) -> Result<(), Stop> {
        if acknowledged > in_order {
            let wrong = Stop::differs(
                "the server acknowledges segments that it did not get in order",
                format!("at most segment {in_order}"),
                format!("segment {acknowledged}"),
                Came::Other,
            );
            return Err(match one_was_lost {
                true => wrong.with_note(format!("segment {} was left out", in_order + 1)),
                false => wrong,
            });
        }
        self.repeats = match acknowledged {
            0 if !one_was_lost => self.repeats + 1,
            _ => 0,
        };
        if self.repeats <= MOST_REPEATS {
            return Ok(());
        }
        Err(Stop::mismatch(
            "the server asks for the same segments again and again",
            "an acknowledge of some segment",
            format!("none, {MOST_REPEATS} times in a row"),
            Came::Other,
        ))
    }
}

/// An acknowledge of a block of an upload, right or wrong.
fn acknowledge(number: u8, block_size: u8) -> [u8; 8] {
    [0xA2, number, block_size, 0, 0, 0, 0, 0]
}

/// A server may only switch for a value that is no longer than the threshold.
fn check_switched(outcome: &Outcome<Uploaded>, threshold: u8) -> Result<(), Stop> {
    match outcome {
        Outcome::Done(value) if value.of_size(None).len() > usize::from(threshold) => {
            Err(Stop::mismatch(
                "the server switches to the ordinary upload above the threshold",
                format!("at most {threshold} bytes"),
                format!("{} bytes", value.of_size(None).len()),
                Came::Other,
            ))
        }
        _ => Ok(()),
    }
}

fn does_not_end() -> Stop {
    Stop::mismatch(
        "the block upload does not end",
        format!("at most {LONGEST_VALUE} bytes"),
        "more",
        Came::Other,
    )
}

/// What the step would do wrong cannot be done with this server.
fn no_occasion(why: &str) -> Stop {
    Stop::undecided(
        format!("the server {why}"),
        "an occasion for this mistake",
        "none",
    )
}
