//! Attachments of messages: number, time and sender.

/// Attachment of a message, request or reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attachment {
    /// Number of the message, counted by its sender; of a reply, that of the request.
    pub number: i64,
    /// Time at which it was sent, in ns since 1970.
    pub time: i64,
    /// Identification of the sender; of a reply, that of the client.
    pub sender: [u8; 16],
}

/// Names before the values in attachments of rmw_zenoh before December 2024 (Humble < 0.1.2, Jazzy < 0.2.4).
const NAMES: [&str; 3] = ["sequence_number", "source_timestamp", "source_gid"];
/// Longest identification of a sender: that of Humble's interface.
const LONGEST: usize = 24;

impl Attachment {
    /// Returns the bytes, in the present form: two numbers of 8 bytes, a length of one byte, and the sender.
    pub fn to_bytes(self) -> [u8; 33] {
        let mut bytes = [0; 33];
        bytes[..8].copy_from_slice(&self.number.to_le_bytes());
        bytes[8..16].copy_from_slice(&self.time.to_le_bytes());
        bytes[16] = self.sender.len() as u8;
        bytes[17..].copy_from_slice(&self.sender);
        bytes
    }

    /// Reads the present form, or the older one with the names of the values; `None` for anything else. Of a longer
    /// sender, the first 16 bytes are kept, and a shorter one is filled with zeros.
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let [first, second, third] = NAMES;
        match after(bytes, first) {
            None => Self::of(bytes.get(..8)?, bytes.get(8..16)?, bytes.get(16..)?),
            Some(rest) => {
                let (number, rest) = rest.split_at_checked(8)?;
                let (time, rest) = after(rest, second)?.split_at_checked(8)?;
                Self::of(number, time, after(rest, third)?)
            }
        }
    }

    /// Attachment of its parts. The sender begins with its length.
    fn of(number: &[u8], time: &[u8], sender: &[u8]) -> Option<Self> {
        let (length, id) = sender.split_first()?;
        if usize::from(*length) != id.len() || id.len() > LONGEST {
            return None;
        }
        let mut sender = [0; 16];
        sender.iter_mut().zip(id).for_each(|(to, byte)| *to = *byte);
        Some(Self {
            number: i64::from_le_bytes(number.try_into().ok()?),
            time: i64::from_le_bytes(time.try_into().ok()?),
            sender,
        })
    }
}

/// Bytes after a name and its length.
fn after<'a>(bytes: &'a [u8], name: &str) -> Option<&'a [u8]> {
    bytes.strip_prefix(&[name.len() as u8][..])?.strip_prefix(name.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Attachment = Attachment { number: 5, time: -1, sender: *b"0123456789abcdef" };

    fn named() -> Vec<u8> {
        let bytes = ONE.to_bytes();
        let name = |i: usize| [&[NAMES[i].len() as u8], NAMES[i].as_bytes()].concat();
        [name(0), bytes[..8].to_vec(), name(1), bytes[8..16].to_vec(), name(2), bytes[16..].to_vec()].concat()
    }

    #[test]
    fn both_forms_are_read() {
        let bytes = ONE.to_bytes();
        assert_eq!((bytes[0], bytes[8], bytes[16], bytes[17]), (5, 255, 16, b'0'));
        assert_eq!(Attachment::read(&bytes), Some(ONE));
        assert_eq!((named().len(), Attachment::read(&named())), (77, Some(ONE)));
    }

    #[test]
    fn senders_may_be_of_another_length() {
        let with = |sender: &[u8]| [&ONE.to_bytes()[..16], &[sender.len() as u8], sender].concat();
        let long = Attachment::read(&with(b"0123456789abcdefghijklmn"));
        assert_eq!(long, Some(ONE));
        let short = Attachment::read(&with(b"01")).expect("two bytes");
        assert_eq!(short.sender[..4], [b'0', b'1', 0, 0]);
        assert_eq!(Attachment::read(&with(&[1; 25])), None);
    }

    #[test]
    fn damaged_ones_are_none() {
        for whole in [ONE.to_bytes().to_vec(), named()] {
            assert!((0..whole.len()).all(|length| Attachment::read(&whole[..length]).is_none()));
            assert_eq!(Attachment::read(&[&whole[..], &[0]].concat()), None);
        }
    }
}
