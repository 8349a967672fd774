//! What the processes of one run tell one another.

use std::fmt::Debug;

/// Numbers to another process, or from it.
#[derive(Clone, Debug, Default)]
pub struct Message {
    /// The other process.
    pub rank: usize,
    /// What it is sent. Of a message that is received, room for the longest that may come; a shorter one fills the front.
    pub numbers: Vec<f64>,
}

/// The processes that share the nodes of one simulation, as one of them sees them. They are numbered from zero; every call is made
/// by all of them, in the same order.
pub trait Ranks: Debug + Send + Sync {
    /// The number of this process.
    fn rank(&self) -> usize;

    /// How many there are.
    fn size(&self) -> usize;

    /// Sends each message of `out` and receives one from each process of `into`; does `beside` while they travel.
    fn exchange(&self, out: &[Message], into: &mut [Message], beside: &mut dyn FnMut());

    /// Replaces each of the `words` by its sum over all processes.
    fn add(&self, words: &mut [i64]);

    /// Whether all processes are `ready`.
    fn all(&self, ready: bool) -> bool {
        let mut unready = [i64::from(!ready)];
        self.add(&mut unready);
        unready == [0]
    }

    /// What process 0 says here.
    fn tell(&self, word: u64) -> u64;

    /// Replaces `bytes` by those of process 0.
    fn broadcast(&self, bytes: &mut Vec<u8>);
}
