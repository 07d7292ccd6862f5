//! The messages between rank 0 and the others, each with a tag of its own.
//!
//! A rank says how many chunks it takes at a time. Each of its slots is answered by an assignment or by a closing; a chunk that is finished asks for the
//! next. When all slots are closed and the ranks have left the folder, rank 0 sends the end. Messages are looked for and not waited for: to wait in MPI takes a whole processor.

use std::time::Duration;

use guen_study::Assignment;
use mpi::point_to_point::MatchedReceiveVec;
use mpi::topology::{Communicator, SimpleCommunicator};
use mpi::traits::{Destination, Source};
use mpi::{Rank, Tag};

/// The pauses between two looks, while nothing comes: twice as long each time.
const SHORTEST_PAUSE: Duration = Duration::from_micros(20);
const LONGEST_PAUSE: Duration = Duration::from_micros(500);

/// A message of rank 0.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Order {
    /// The folder is ready for workers.
    Begin,
    /// A chunk for a slot.
    Compute(Assignment),
    /// No further chunk for a slot.
    Close,
    /// The end of the run; with the rank that has failed and its error, if one has.
    End(Option<(Rank, String)>),
}

/// A message of another rank.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Answer {
    /// The rank has joined the folder, and has so many slots.
    Ready(u64),
    /// A chunk is finished: the text for the coordinator. Its slot is free.
    Finished(String),
    /// A chunk could not be computed. Its slot is closed.
    Failed(String),
    /// The rank could not join the folder.
    Refused(String),
    /// All slots of the rank are closed, and it is no longer at work in the folder.
    Left,
}

const BEGIN: Tag = 0;
const COMPUTE: Tag = 1;
const CLOSE: Tag = 2;
const DONE: Tag = 3;
const BROKEN: Tag = 4;
const READY: Tag = 5;
const FINISHED: Tag = 6;
const REFUSED: Tag = 7;
const FAILED: Tag = 8;
const LEFT: Tag = 9;

impl Order {
    fn encode(&self) -> (Tag, Vec<u8>) {
        match self {
            Self::Begin => (BEGIN, Vec::new()),
            Self::Compute(assignment) => (COMPUTE, assignment.to_bits().to_le_bytes().to_vec()),
            Self::Close => (CLOSE, Vec::new()),
            Self::End(None) => (DONE, Vec::new()),
            Self::End(Some((rank, cause))) => (BROKEN, [&rank.to_le_bytes(), cause.as_bytes()].concat()),
        }
    }

    /// Reads what [`encode`](Self::encode) wrote; none of anything else.
    fn decode(tag: Tag, bytes: &[u8]) -> Option<Self> {
        match tag {
            BEGIN => Some(Self::Begin),
            COMPUTE => Some(Self::Compute(Assignment::from_bits(u64::from_le_bytes(bytes.try_into().ok()?)))),
            CLOSE => Some(Self::Close),
            DONE => Some(Self::End(None)),
            BROKEN => {
                let (rank, cause) = bytes.split_first_chunk()?;
                Some(Self::End(Some((Rank::from_le_bytes(*rank), text(cause)))))
            }
            _ => None,
        }
    }

    pub(crate) fn send(&self, world: &SimpleCommunicator, rank: Rank) {
        let (tag, bytes) = self.encode();
        world.process_at_rank(rank).send_with_tag(&bytes[..], tag);
    }

    /// The next order of rank 0, if one has come.
    pub(crate) fn receive(world: &SimpleCommunicator) -> Option<Self> {
        let (bytes, status) = world.process_at_rank(0).immediate_matched_probe()?.matched_receive_vec::<u8>();
        Some(Self::decode(status.tag(), &bytes).expect("rank 0 speaks this language"))
    }
}

impl Answer {
    fn encode(&self) -> (Tag, Vec<u8>) {
        match self {
            Self::Ready(slots) => (READY, slots.to_le_bytes().to_vec()),
            Self::Finished(text) => (FINISHED, text.clone().into_bytes()),
            Self::Refused(cause) => (REFUSED, cause.clone().into_bytes()),
            Self::Failed(cause) => (FAILED, cause.clone().into_bytes()),
            Self::Left => (LEFT, Vec::new()),
        }
    }

    /// Reads what [`encode`](Self::encode) wrote; none of anything else.
    fn decode(tag: Tag, bytes: &[u8]) -> Option<Self> {
        match tag {
            READY => Some(Self::Ready(u64::from_le_bytes(bytes.try_into().ok()?))),
            FINISHED => Some(Self::Finished(text(bytes))),
            REFUSED => Some(Self::Refused(text(bytes))),
            FAILED => Some(Self::Failed(text(bytes))),
            LEFT => Some(Self::Left),
            _ => None,
        }
    }

    pub(crate) fn send(&self, world: &SimpleCommunicator) {
        let (tag, bytes) = self.encode();
        world.process_at_rank(0).send_with_tag(&bytes[..], tag);
    }

    /// The next answer of any rank, if one has come.
    pub(crate) fn receive(world: &SimpleCommunicator) -> Option<(Rank, Self)> {
        let (bytes, status) = world.any_process().immediate_matched_probe()?.matched_receive_vec::<u8>();
        let answer = Self::decode(status.tag(), &bytes).expect("all ranks speak this language");
        Some((status.source_rank(), answer))
    }
}

/// Words that were sent. Bytes that are none end as such in the check of their digest.
fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The pause before the next look for messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience(Duration);

impl Patience {
    pub(crate) fn new() -> Self {
        Self(SHORTEST_PAUSE)
    }

    /// Something has come: more may follow soon.
    pub(crate) fn renew(&mut self) {
        self.0 = SHORTEST_PAUSE;
    }

    /// Returns the pause, and makes the next one longer.
    pub(crate) fn pause(&mut self) -> Duration {
        let pause = self.0;
        self.0 = LONGEST_PAUSE.min(2 * pause);
        pause
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_read_as_they_were_sent() {
        for order in [
            Order::Begin,
            Order::Compute(Assignment::from_bits(u64::MAX - 4)),
            Order::Close,
            Order::End(None),
            Order::End(Some((3, "`rows`: no space".to_owned()))),
        ] {
            let (tag, bytes) = order.encode();
            assert_eq!(Order::decode(tag, &bytes), Some(order));
            assert_eq!(Answer::decode(tag, &bytes), None);
        }
        for answer in [
            Answer::Ready(7),
            Answer::Finished("chunk 0".to_owned()),
            Answer::Refused("elsewhere".to_owned()),
            Answer::Failed("full".to_owned()),
            Answer::Left,
        ] {
            let (tag, bytes) = answer.encode();
            assert_eq!(Answer::decode(tag, &bytes), Some(answer));
            assert_eq!(Order::decode(tag, &bytes), None);
        }
        assert_eq!(Order::decode(COMPUTE, &[1, 2]), None);
        assert_eq!(Answer::decode(READY, &[]), None);
    }

    #[test]
    fn pauses_grow_until_something_comes() {
        let mut patience = Patience::new();
        let pauses: Vec<Duration> = (0..8).map(|_| patience.pause()).collect();
        assert_eq!((pauses[0], pauses[7]), (SHORTEST_PAUSE, LONGEST_PAUSE));
        assert!(pauses.is_sorted());
        patience.renew();
        assert_eq!(patience.pause(), SHORTEST_PAUSE);
    }
}
