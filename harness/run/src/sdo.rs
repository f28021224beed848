//! The SDO client: one upload or download, every frame checked against the object that was asked for.

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_wire::canopen::sdo::{Data, RawSdo, Request, Response, Segment, Transfer};
use fieldproof_wire::canopen::{AbortCode, Multiplexer, NodeId, Service, cob_id};
use fieldproof_wire::describe::describe_frame;

use crate::stop::{Came, Stop};
use crate::tester::Tester;

/// How a transfer ended that both sides carried out by the rules.
#[derive(Debug)]
pub(crate) enum Outcome<T> {
    Done(T),
    /// The server refused, naming the right object.
    Refused(AbortCode),
}

/// A value that was read. A server may leave open how many of the four expedited bytes are data (command 42h).
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Uploaded {
    bytes: Vec<u8>,
    size_is_given: bool,
    pub(crate) protocol: Protocol,
}

/// How a value came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Protocol {
    Expedited,
    Segmented,
    Block,
}

impl Protocol {
    /// To be put behind an object.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Protocol::Expedited => "",
            Protocol::Segmented => " in segments",
            Protocol::Block => " in blocks",
        }
    }
}

impl Uploaded {
    /// The value: what was given, or where the server left its size open, as many bytes as the object has.
    pub(crate) fn of_size(&self, size: Option<usize>) -> &[u8] {
        match size {
            Some(size) if !self.size_is_given => self.bytes.get(..size).unwrap_or(&self.bytes),
            _ => &self.bytes,
        }
    }

    pub(crate) fn sized(bytes: Vec<u8>, protocol: Protocol) -> Uploaded {
        Uploaded {
            bytes,
            size_is_given: true,
            protocol,
        }
    }
}

/// Of the two ordinary protocols, the one that must be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Only {
    /// At most 4 bytes, in the initiate frames.
    Expedited,
    /// In segments, whatever the size.
    Segmented,
}

/// A value longer than this is not what a field device has; a server that never ends would otherwise fill the memory.
pub(crate) const LONGEST_VALUE: usize = 1 << 20;

impl Tester<'_> {
    /// Reads an object: expedited or segmented, as the server chooses.
    pub(crate) fn sdo_upload(
        &mut self,
        object: Multiplexer,
        within: Duration,
    ) -> Result<Outcome<Uploaded>, Stop> {
        self.sdo_upload_by(object, None, within)
    }

    /// Reads an object, and fails if the server chooses another protocol than `only`.
    pub(crate) fn sdo_upload_by(
        &mut self,
        object: Multiplexer,
        only: Option<Only>,
        within: Duration,
    ) -> Result<Outcome<Uploaded>, Stop> {
        match self.sdo_exchange(Request::InitiateUpload(object), within)? {
            Response::Abort {
                object: named,
                code,
            } => refused(object, named, code),
            Response::InitiateUpload {
                object: named,
                transfer,
            } => {
                check_object("the answer to the read", object, named)?;
                check_protocol(only, transfer)?;
                self.finish_upload(object, transfer, within)
            }
            other => Err(wrong_service("an answer to initiate upload", &other)),
        }
    }

    /// Takes the value that an ordinary upload was answered with.
    pub(crate) fn finish_upload(
        &mut self,
        object: Multiplexer,
        transfer: Transfer,
        within: Duration,
    ) -> Result<Outcome<Uploaded>, Stop> {
        match transfer {
            Transfer::Expedited(data) => Ok(Outcome::Done(Uploaded::sized(
                data.bytes().to_vec(),
                Protocol::Expedited,
            ))),
            Transfer::ExpeditedUnsized(data) => Ok(Outcome::Done(Uploaded {
                bytes: data.to_vec(),
                size_is_given: false,
                protocol: Protocol::Expedited,
            })),
            Transfer::Segmented { size } => {
                // Until the last segment has come the server waits for the next request.
                self.open_transfer = Some(object);
                let value = self.upload_segments(object, size, within)?;
                self.open_transfer = None;
                Ok(value)
            }
        }
    }

    fn upload_segments(
        &mut self,
        object: Multiplexer,
        size: Option<u32>,
        within: Duration,
    ) -> Result<Outcome<Uploaded>, Stop> {
        let mut value = Vec::new();
        let mut toggle = false;
        loop {
            match self.sdo_exchange(Request::UploadSegment { toggle }, within)? {
                Response::Abort {
                    object: named,
                    code,
                } => {
                    // The server has nothing left to send, and has not said so.
                    if size.is_some_and(|size| size as usize == value.len()) {
                        return Err(Stop::mismatch(
                            format!("no segment of {object} is marked as the last"),
                            "the last segment says that it is the last",
                            format!("abort {} for {named}", show_abort(code)),
                            Came::Abort(code.0),
                        ));
                    }
                    return refused(object, named, code);
                }
                Response::UploadSegment(segment) => {
                    check_toggle(segment.toggle, toggle)?;
                    value.extend_from_slice(segment.data.bytes());
                    if segment.last {
                        break;
                    }
                    if value.len() > LONGEST_VALUE {
                        return Err(Stop::mismatch(
                            "the segmented upload does not end",
                            format!("at most {LONGEST_VALUE} bytes"),
                            "more",
                            Came::Other,
                        ));
                    }
                    toggle = !toggle;
                }
                other => return Err(wrong_service("an upload segment", &other)),
            }
        }
        match size {
            Some(size) if size as usize != value.len() => Err(Stop::differs(
                "the segments do not carry as many bytes as the server announced",
                format!("{size} bytes"),
                format!("{} bytes", value.len()),
                Came::Other,
            )),
            _ => Ok(Outcome::Done(Uploaded::sized(value, Protocol::Segmented))),
        }
    }

    /// Writes an object: expedited up to 4 bytes, else segmented.
    pub(crate) fn sdo_download(
        &mut self,
        object: Multiplexer,
        value: &[u8],
        within: Duration,
    ) -> Result<Outcome<()>, Stop> {
        self.sdo_download_by(object, value, None, within)
    }

    /// Writes an object by one of the two ordinary protocols.
    pub(crate) fn sdo_download_by(
        &mut self,
        object: Multiplexer,
        value: &[u8],
        only: Option<Only>,
        within: Duration,
    ) -> Result<Outcome<()>, Stop> {
        let transfer = match (Data::new(value), only) {
            (Some(data), None | Some(Only::Expedited)) => Transfer::Expedited(data),
            (None, Some(Only::Expedited)) => {
                return Err(Stop::Bench(format!(
                    "{} bytes cannot be written expedited",
                    value.len()
                )));
            }
            (_, Some(Only::Segmented)) | (None, None) => Transfer::Segmented {
                size: Some(value.len() as u32),
            },
        };
        match self.sdo_exchange(Request::InitiateDownload { object, transfer }, within)? {
            Response::Abort {
                object: named,
                code,
            } => refused(object, named, code),
            Response::InitiateDownload(named) => {
                check_object("the answer to the write", object, named)?;
                match transfer {
                    Transfer::Segmented { .. } => {
                        self.open_transfer = Some(object);
                        let done = self.download_segments(object, value, within)?;
                        self.open_transfer = None;
                        Ok(done)
                    }
                    Transfer::Expedited(_) | Transfer::ExpeditedUnsized(_) => Ok(Outcome::Done(())),
                }
            }
            other => Err(wrong_service("an answer to initiate download", &other)),
        }
    }

    fn download_segments(
        &mut self,
        object: Multiplexer,
        value: &[u8],
        within: Duration,
    ) -> Result<Outcome<()>, Stop> {
        let mut toggle = false;
        let count = value.chunks(7).count().max(1);
        for number in 0..count {
            let part = value.chunks(7).nth(number).unwrap_or_default();
            let Some(data) = Data::new(part) else {
                return Err(Stop::Bench("a segment holds 7 bytes".into()));
            };
            let segment = Segment {
                toggle,
                last: number + 1 == count,
                data,
            };
            if segment.last {
                self.watch.wrote(object, value);
            }
            match self.sdo_exchange(Request::DownloadSegment(segment), within)? {
                Response::Abort {
                    object: named,
                    code,
                } => return refused(object, named, code),
                Response::DownloadSegment { toggle: answered } => check_toggle(answered, toggle)?,
                other => return Err(wrong_service("an answer to the download segment", &other)),
            }
            toggle = !toggle;
        }
        Ok(Outcome::Done(()))
    }

    /// Gives up a transfer that went wrong half-way, so that the server does not wait for the rest of it.
    pub(crate) fn abort_open_transfer(&mut self) -> Result<(), Stop> {
        let Some(object) = self.open_transfer.take() else {
            return Ok(());
        };
        let abort = Request::Abort {
            object,
            code: AbortCode::GENERAL_ERROR,
        };
        let request_id = self.identifier(Service::SdoRequest)?;
        self.send_frame(Frame::of_eight(request_id, abort.encode()))
    }

    /// One request and its answer.
    fn sdo_exchange(&mut self, request: Request, within: Duration) -> Result<Response, Stop> {
        self.sdo_exchange_bytes(request.encode(), within)
    }

    /// One request, right or wrong, and its answer.
    pub(crate) fn sdo_exchange_bytes(
        &mut self,
        request: [u8; 8],
        within: Duration,
    ) -> Result<Response, Stop> {
        self.send_sdo(request)?;
        self.sdo_answer("SDO response time", within)
    }

    pub(crate) fn send_sdo(&mut self, request: [u8; 8]) -> Result<(), Stop> {
        let request_id = self.identifier(Service::SdoRequest)?;
        let request = Frame::of_eight(request_id, request);
        self.sdo_request = Some(request);
        self.send_frame(request)
    }

    /// The answer to what was sent last; `time` is what its measurement is called.
    pub(crate) fn sdo_answer(
        &mut self,
        time: &'static str,
        within: Duration,
    ) -> Result<Response, Stop> {
        let response_id = self.identifier(Service::SdoResponse)?;
        let Some((frame, received)) = self.first_frame(Id::Standard(response_id), within)? else {
            return Err(Stop::mismatch(
                format!(
                    "the SDO server does not answer: {}",
                    self.sdo_request
                        .map_or_else(String::new, |it| describe_frame(&it))
                ),
                format!("an answer within {}", crate::limits::show(within)),
                "nothing",
                Came::Silence,
            ));
        };
        self.watch.confirmed(received.at);
        self.measure_response(time, &received, within)?;
        read_response(&frame)
    }
}

pub(crate) fn malformed(frame: &Frame, expected: String, found: String) -> Stop {
    Stop::mismatch(
        format!("the SDO answer is malformed: {found}, and not {expected}"),
        expected,
        found,
        Came::Frame(*frame),
    )
}

pub(crate) fn read_response(frame: &Frame) -> Result<Response, Stop> {
    let malformed = |expected, found| malformed(frame, expected, found);
    if frame.is_remote() {
        return Err(malformed("a data frame".into(), "a remote frame".into()));
    }
    RawSdo::from_slice(frame.bytes())
        .and_then(|raw| Response::parse(&raw.0))
        .map_err(|violation| {
            malformed(violation.expected, format!("{} ({frame})", violation.found))
        })
}

fn check_protocol(only: Option<Only>, came: Transfer) -> Result<(), Stop> {
    let (expected, found) = match (only, came) {
        (Some(Only::Expedited), Transfer::Segmented { .. }) => ("expedited", "segmented"),
        (Some(Only::Segmented), Transfer::Expedited(_) | Transfer::ExpeditedUnsized(_)) => {
            ("segmented", "expedited")
        }
        _ => return Ok(()),
    };
    Err(Stop::differs(
        "the server chooses another protocol for the upload",
        expected,
        found,
        Came::Answer,
    ))
}

pub(crate) fn refused<T>(
    asked: Multiplexer,
    named: Multiplexer,
    code: AbortCode,
) -> Result<Outcome<T>, Stop> {
    check_object("the abort", asked, named)?;
    Ok(Outcome::Refused(code))
}

pub(crate) fn check_object(what: &str, asked: Multiplexer, named: Multiplexer) -> Result<(), Stop> {
    if asked == named {
        return Ok(());
    }
    Err(Stop::mismatch(
        format!("{what} names another object: {named}, and not {asked}"),
        asked.to_string(),
        named.to_string(),
        Came::Other,
    ))
}

fn check_toggle(answered: bool, asked: bool) -> Result<(), Stop> {
    if answered == asked {
        return Ok(());
    }
    Err(Stop::differs(
        "the toggle bit of the segment is not that of the request",
        format!("toggle {}", u8::from(asked)),
        format!("toggle {}", u8::from(answered)),
        Came::Other,
    ))
}

pub(crate) fn wrong_service(expected: &str, came: &Response) -> Stop {
    // Whose answer it is makes no difference to its words.
    let id = cob_id(Service::SdoResponse, Some(NodeId::MIN));
    let frame = Frame::of_eight(id, came.encode());
    Stop::differs(
        "the SDO server answers with another service",
        expected,
        describe_frame(&frame),
        Came::Other,
    )
}

/// `06090011h (sub-index does not exist)`
pub(crate) fn show_abort(code: AbortCode) -> String {
    match code.meaning() {
        Some(meaning) => format!("{:08X}h ({meaning})", code.0),
        None => format!("{:08X}h (not in CiA 301)", code.0),
    }
}
