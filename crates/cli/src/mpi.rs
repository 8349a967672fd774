//! The processes of MPI.

use std::sync::{Arc, Mutex, PoisonError};

use creepage::{Message, Ranks};
use mpi::collective::SystemOperation;
use mpi::request::multiple_scope;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Root, Source};

/// Bytes that are broadcast at a time, fewer than MPI can count.
const MOST: usize = 1 << 30;

/// MPI, until it is dropped.
pub struct Universe {
    _universe: mpi::environment::Universe,
}

impl Universe {
    /// None where MPI is in use already, or cannot be called from the threads of a pool.
    pub fn new() -> Option<Self> {
        let (universe, given) = mpi::initialize_with_threading(mpi::Threading::Serialized)?;
        (given >= mpi::Threading::Serialized).then_some(Self { _universe: universe })
    }

    /// All processes.
    pub fn ranks(&self) -> Arc<dyn Ranks> {
        Arc::new(World::default())
    }
}

impl Drop for Universe {
    fn drop(&mut self) {
        if std::thread::panicking() {
            // the others wait for what this process no longer sends
            SimpleCommunicator::world().abort(3);
        }
    }
}

/// The communicator of all processes. MPI's handle of it may not move between threads, but each can ask for it.
#[derive(Debug, Default)]
struct World {
    /// The words to be added up.
    words: Mutex<Vec<i64>>,
}

impl World {
    fn communicator() -> SimpleCommunicator {
        SimpleCommunicator::world()
    }
}

impl Ranks for World {
    fn rank(&self) -> usize {
        Self::communicator().rank() as usize
    }

    fn size(&self) -> usize {
        Self::communicator().size() as usize
    }

    fn exchange(&self, out: &[Message], into: &mut [Message], beside: &mut dyn FnMut()) {
        let world = Self::communicator();
        multiple_scope(out.len() + into.len(), |scope, requests| {
            for Message { rank, numbers } in into {
                let from = world.process_at_rank(*rank as i32);
                requests.add(from.immediate_receive_into(scope, &mut numbers[..]));
            }
            for Message { rank, numbers } in out {
                let to = world.process_at_rank(*rank as i32);
                requests.add(to.immediate_send(scope, &numbers[..]));
            }
            beside();
            requests.wait_all(&mut Vec::new());
        });
    }

    fn add(&self, words: &mut [i64]) {
        let mut mine = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        mine.clear();
        mine.extend_from_slice(words);
        Self::communicator().all_reduce_into(&mine[..], words, SystemOperation::sum());
    }

    fn tell(&self, word: u64) -> u64 {
        let mut word = word;
        Self::communicator().process_at_rank(0).broadcast_into(&mut word);
        word
    }

    fn broadcast(&self, bytes: &mut Vec<u8>) {
        let length = self.tell(bytes.len() as u64) as usize;
        bytes.resize(length, 0);
        let world = Self::communicator();
        bytes.chunks_mut(MOST).for_each(|part| world.process_at_rank(0).broadcast_into(part));
    }
}
