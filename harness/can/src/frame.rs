//! The classic CAN frame.

use crate::{Id, StandardId};

/// A classic CAN data or remote frame with 0 to 8 data bytes. Small and `Copy`, for it travels a lot.
///
/// A remote frame carries a length and no bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Frame {
    id: Id,
    remote: bool,
    len: u8,
    /// Bytes at and after `len` are zero, so that equality means equal frames.
    data: [u8; 8],
}

impl Frame {
    /// A data frame; `None` if `data` is longer than 8 bytes.
    pub fn data(id: impl Into<Id>, data: &[u8]) -> Option<Frame> {
        let mut bytes = [0; 8];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        Some(Frame {
            id: id.into(),
            remote: false,
            len: data.len() as u8,
            data: bytes,
        })
    }

    /// A data frame of a length that is known when the program is built; more than 8 bytes do not compile.
    pub fn of<const LEN: usize>(id: impl Into<Id>, data: [u8; LEN]) -> Frame {
        const { assert!(LEN <= 8, "a classic frame has at most 8 bytes") };
        let mut bytes = [0; 8];
        bytes[..LEN].copy_from_slice(&data);
        Frame {
            id: id.into(),
            remote: false,
            len: LEN as u8,
            data: bytes,
        }
    }

    /// A data frame of exactly 8 bytes on an 11-bit identifier, the shape of SDO and LSS.
    pub fn of_eight(id: StandardId, data: [u8; 8]) -> Frame {
        Frame {
            id: Id::Standard(id),
            remote: false,
            len: 8,
            data,
        }
    }

    /// A remote frame that asks for `len` bytes; `None` if `len` is over 8.
    pub fn remote(id: impl Into<Id>, len: u8) -> Option<Frame> {
        (len <= 8).then(|| Frame {
            id: id.into(),
            remote: true,
            len,
            data: [0; 8],
        })
    }

    /// A remote frame that asks for a length that is known when the program is built; more than 8 does not compile.
    pub fn remote_of<const LEN: u8>(id: impl Into<Id>) -> Frame {
        const { assert!(LEN <= 8, "a classic frame has at most 8 bytes") };
        Frame {
            id: id.into(),
            remote: true,
            len: LEN,
            data: [0; 8],
        }
    }

    /// The identifier.
    pub fn id(&self) -> Id {
        self.id
    }

    /// The 11-bit identifier, if it is one.
    pub fn standard_id(&self) -> Option<StandardId> {
        match self.id {
            Id::Standard(id) => Some(id),
            Id::Extended(_) => None,
        }
    }

    /// Whether this is a remote frame.
    pub fn is_remote(&self) -> bool {
        self.remote
    }

    /// The data length code, `0..=8`.
    pub fn len(&self) -> usize {
        usize::from(self.len)
    }

    /// Whether the data length code is 0.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The data bytes; none in a remote frame.
    pub fn bytes(&self) -> &[u8] {
        if self.remote {
            &[]
        } else {
            &self.data[..self.len()]
        }
    }

    /// The same frame under another identifier.
    pub fn with_id(self, id: impl Into<Id>) -> Frame {
        Frame {
            id: id.into(),
            ..self
        }
    }
}

#[cfg(test)]
pub(crate) use tests::any_frame;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(crate) fn any_frame() -> impl Strategy<Value = Frame> {
        let id = prop_oneof![
            (0..=0x7FFu16).prop_map(|raw| Id::standard(raw).unwrap()),
            (0..=0x1FFF_FFFFu32).prop_map(|raw| Id::extended(raw).unwrap()),
        ];
        let data = proptest::collection::vec(any::<u8>(), 0..=8);
        prop_oneof![
            4 => (id.clone(), data).prop_map(|(id, data)| Frame::data(id, &data).unwrap()),
            1 => (id, 0..=8u8).prop_map(|(id, len)| Frame::remote(id, len).unwrap()),
        ]
    }

    #[test]
    fn a_classic_frame_has_at_most_eight_bytes() {
        let id = StandardId::MAX;
        assert_eq!(Frame::data(id, &[0; 9]), None);
        assert_eq!(Frame::remote(id, 9), None);
        assert_eq!(Frame::data(id, &[1, 2]), Some(Frame::of(id, [1, 2])));
        assert_eq!(Frame::remote(id, 3), Some(Frame::remote_of::<3>(id)));
        assert_eq!(Frame::data(id, &[7; 8]), Some(Frame::of_eight(id, [7; 8])));
    }
}
