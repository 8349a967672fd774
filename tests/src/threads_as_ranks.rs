//! Processes of one run as threads of this one: what MPI does, without it.

use creepage::{Message, Ranks};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Barrier, Mutex};

/// One of several threads that share a run.
#[derive(Debug)]
pub struct ThreadRank {
    rank: usize,
    meeting: Arc<Meeting>,
    to: Vec<Mutex<Sender<Vec<f64>>>>,
    from: Vec<Mutex<Receiver<Vec<f64>>>>,
}

/// Where all of them meet.
#[derive(Debug)]
struct Meeting {
    barrier: Barrier,
    words: Mutex<Vec<i64>>,
    bytes: Mutex<Vec<u8>>,
}

/// So many of them, rank 0 first.
pub fn threads_as_ranks(size: usize) -> Vec<Arc<dyn Ranks>> {
    let (words, bytes) = Default::default();
    let meeting = Arc::new(Meeting { barrier: Barrier::new(size), words, bytes });
    let member = |rank| ThreadRank { rank, meeting: meeting.clone(), to: vec![], from: vec![] };
    let mut ranks: Vec<_> = (0..size).map(member).collect();
    for from in 0..size {
        for to in 0..size {
            let (sender, receiver) = channel();
            ranks[from].to.push(Mutex::new(sender));
            ranks[to].from.push(Mutex::new(receiver));
        }
    }
    ranks.into_iter().map(|rank| Arc::new(rank) as Arc<dyn Ranks>).collect()
}

impl ThreadRank {
    /// Rank 0 lays `from` down; the others take it up.
    fn hand_round(&self, bytes: &mut Vec<u8>) {
        let Meeting { barrier, bytes: laid_down, .. } = &*self.meeting;
        if self.rank == 0 {
            laid_down.lock().unwrap().clone_from(bytes);
        }
        barrier.wait();
        bytes.clone_from(&laid_down.lock().unwrap());
        barrier.wait();
    }
}

impl Ranks for ThreadRank {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.to.len()
    }

    fn exchange(&self, out: &[Message], into: &mut [Message], beside: &mut dyn FnMut()) {
        for message in out {
            self.to[message.rank].lock().unwrap().send(message.numbers.clone()).unwrap();
        }
        beside();
        for message in into {
            let numbers = self.from[message.rank].lock().unwrap().recv().unwrap();
            message.numbers[..numbers.len()].copy_from_slice(&numbers);
        }
    }

    fn add(&self, words: &mut [i64]) {
        let Meeting { barrier, words: sums, .. } = &*self.meeting;
        {
            let mut sums = sums.lock().unwrap();
            sums.resize(words.len(), 0);
            sums.iter_mut().zip(&*words).for_each(|(sum, word)| *sum += word);
        }
        barrier.wait();
        words.copy_from_slice(&sums.lock().unwrap());
        if barrier.wait().is_leader() {
            sums.lock().unwrap().clear();
        }
        barrier.wait();
    }

    fn tell(&self, word: u64) -> u64 {
        let mut bytes = word.to_le_bytes().to_vec();
        self.hand_round(&mut bytes);
        u64::from_le_bytes(bytes.try_into().unwrap())
    }

    fn broadcast(&self, bytes: &mut Vec<u8>) {
        self.hand_round(bytes);
    }
}
