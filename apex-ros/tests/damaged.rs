//! Damaged tokens and attachments: nothing panics, and what is read is written in the same way.

use apex_nodes::math;
use apex_ros::{Attachment, Qos, Token};
use std::env;

/// Returns the number of damaged texts of each kind: `APEX_DAMAGED`, or 500,000.
fn count() -> usize {
    env::var("APEX_DAMAGED").map_or(500_000, |count| count.parse().expect("a number"))
}

/// Pseudo-random damage.
struct Random(math::Random);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0.below(end as u64) as usize
    }

    /// Changes, removes, inserts or repeats some bytes.
    fn damage(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut damaged = bytes.to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(damaged.len() + 1);
            match self.below(4) {
                0 if at < damaged.len() => damaged[at] = b"/%:,0129@xM\0\xff"[self.below(13)],
                1 => damaged.truncate(at),
                2 => damaged.insert(at, b"/%:,0129@xM\0\xff"[self.below(13)]),
                _ => {
                    let rest = damaged[at..].to_vec();
                    damaged.extend(rest);
                    damaged.truncate(1000);
                }
            }
        }
        damaged
    }
}

#[test]
fn damaged_tokens_are_tokens_or_refused() {
    let whole =
        b"@ros2_lv/0/999bf91283606d2068c7524e5badfa6c/0/1/MP/%/%robot1/talker/%chatter/std_msgs::msg::dds_::String_/\
                  RIHS01_df66/2:1:,1000:1,5:10,0:3,0,7/x";
    let (count, mut random, mut read) = (count(), Random(math::Random::new(7)), 0);
    for _ in 0..count {
        let text = String::from_utf8_lossy(&random.damage(whole)).into_owned();
        if let Ok(token) = text.parse::<Token>() {
            read += 1;
            assert_eq!(token.to_string().parse(), Ok(token), "{text}");
        }
        let qos = Qos::read(&text);
        assert_eq!(Qos::read(&qos.to_string()), qos, "{text}");
    }
    assert!(read > count / 20, "{read}");
}

#[test]
fn damaged_attachments_are_attachments_or_refused() {
    let plain = Attachment { number: 5, time: -1, sender: *b"0123456789abcdef" }.to_bytes();
    let name = |name: &str| [&[name.len() as u8], name.as_bytes()].concat();
    let named = [
        name("sequence_number"),
        plain[..8].to_vec(),
        name("source_timestamp"),
        plain[8..16].to_vec(),
        name("source_gid"),
        plain[16..].to_vec(),
    ]
    .concat();
    let (count, mut random, mut read) = (count(), Random(math::Random::new(11)), 0);
    for round in 0..count {
        let damaged = random.damage(if round % 2 == 0 { &plain } else { &named });
        if let Some(attachment) = Attachment::read(&damaged) {
            read += 1;
            assert_eq!(Attachment::read(&attachment.to_bytes()), Some(attachment));
        }
    }
    assert!(read > count / 20, "{read}");
}
