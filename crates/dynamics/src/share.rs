//! The share of one process of a simulation that several processes step together.
//!
//! Each process holds all arrays, and owns some of the nodes: it computes every element that touches one of them, in the order of
//! the whole, so that the forces on its nodes have the bits of one process alone. Velocities of the nodes that its elements have
//! besides come from their owners after every step, and displacements follow from them as they do there. Sums
//! are exact, and travel so. Process 0 has the contact: the others send it the forces on their nodes of both surfaces, and it
//! sends those that contact loads back with the forces of contact. Where the mesh follows the patch, process 0 moves it, and the others
//! take the state after the move. It also leads: the others do what it tells them.

use crate::nodal_state::NodalState;
use crate::partition::{CHUNK, Partition};
use crate::ranks::{Message, Ranks};
use crate::simulation::Simulation;
use crate::state::{RestoreError, SimulationState};
use crate::step_sums::StepSums;
use crate::system::System;
use contact::{Contact, Trace};
use exact_sum::ExactSum;
use mesh::Padded;
use solid::Solid;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What process 0 tells the others to do.
const STEP: u64 = 1;
const STEP_AND_READ: u64 = 2;
const GATHER: u64 = 3;
const TAKE_STATE: u64 = 4;
const END: u64 = 5;

/// A share of the nodes, and what travels between it and the others.
pub(crate) struct Share {
    ranks: Arc<dyn Ranks>,
    partition: Partition,
    chunks: Chunks,
    /// Nodes of its elements that others own.
    foreign: Vec<u32>,
    /// Velocities after a step.
    halo: Mail,
    /// Of the nodes of the contact surfaces that others than process 0 own: forces to it, and back.
    surface: Mail,
    /// Of the nodes of the contact surfaces, the message that takes their forces, if any does, and whether it has them already.
    addressed: Vec<(Option<usize>, bool)>,
    /// Whether this process has all displacements and velocities.
    complete: bool,
    words: Vec<i64>,
    /// How long it has waited for others in steps since that was last taken.
    waited: Duration,
}

/// The chunks of a process, in the order in which it advances them.
struct Chunks {
    /// While contact is elsewhere: those without nodes of its surfaces.
    beside_contact: Vec<bool>,
    /// Then those that others read.
    read_by_others: Vec<bool>,
    /// While their velocities travel: the others.
    beside_halo: Vec<bool>,
}

/// Numbers of a message of vectors, and of one of [`write_loaded`], by its nodes.
const VECTORS: fn(usize) -> usize = |nodes| 3 * nodes;
const LOADED: fn(usize) -> usize = |nodes| 1 + 4 * nodes;

/// Messages, and the nodes that each is of.
#[derive(Default)]
struct Mail {
    out: Vec<Message>,
    sent: Vec<Vec<u32>>,
    into: Vec<Message>,
    received: Vec<Vec<u32>>,
}

impl Mail {
    /// Messages of these nodes to and from each process, where there are any, with room for as many numbers as `rooms` says of so
    /// many nodes.
    fn new(sent: Vec<Vec<u32>>, received: Vec<Vec<u32>>, rooms: [fn(usize) -> usize; 2]) -> Self {
        let both = [(sent, rooms[0]), (received, rooms[1])];
        let [(sent, out), (received, into)] = both.map(|(nodes, room)| {
            let any = nodes.into_iter().enumerate().filter(|(_, nodes)| !nodes.is_empty());
            let with_room = |(rank, nodes): (usize, Vec<u32>)| {
                let numbers = vec![0.0; room(nodes.len())];
                (nodes, Message { rank, numbers })
            };
            any.map(with_room).unzip()
        });
        Self { out, sent, into, received }
    }
}

impl Share {
    /// Takes the share of this process of the system and of its nodes; the others must do so at the same time.
    fn new(
        ranks: Arc<dyn Ranks>,
        partition: Partition,
        system: &mut System,
        nodes: &mut NodalState,
    ) -> Self {
        let me = ranks.rank();
        let count = nodes.inverse_mass.len();
        let trace = system.contact.as_deref().map(|contact| contact.trace());
        let foreign = take_elements(&mut system.solid, &partition, me, trace);
        // every process places the nodes of the hub itself
        let carried = carried(count, system.hub.iter().flat_map(|hub| &hub.nodes));
        let travelling = foreign.iter().copied().filter(|&node| !carried[node as usize]);
        let wanted = by_owner(&partition, ranks.size(), travelling);
        let halo = Mail::new(asked_of(&*ranks, &wanted), wanted, [VECTORS; 2]);

        let surfaces = trace.map_or(&[][..], |trace| trace.nodes());
        let mut on_surface = by_owner(&partition, ranks.size(), surfaces.iter().copied());
        on_surface[0].clear();
        let surface = if me == 0 {
            Mail::new(on_surface.clone(), on_surface, [LOADED, VECTORS])
        } else {
            let mine = || vec![on_surface[me].clone()];
            Mail::new(mine(), mine(), [VECTORS, LOADED])
        };

        let chunks = Chunks::new(&partition, me, halo.sent.iter().flatten(), surfaces);
        let message =
            |node: &u32| surface.out.iter().position(|m| m.rank == partition.owner(*node));
        let addressed = surfaces.iter().map(|node| (message(node), false)).collect();
        if me != 0 {
            (system.contact, nodes.trace) = (None, None);
        }
        let words = vec![0; StepSums::WORDS];
        let (complete, waited) = (true, Duration::ZERO);
        Self {
            chunks,
            foreign,
            halo,
            surface,
            addressed,
            complete,
            words,
            waited,
            partition,
            ranks,
        }
    }

    /// What each process does and sends.
    fn sizes(&self, solid: &Solid, nodes: usize) -> Vec<ShareSize> {
        let (me, processes) = (self.ranks.rank(), self.ranks.size());
        let owned = (0..nodes as u32).filter(|&node| self.owns(node)).count();
        let numbers: usize =
            self.halo.out.iter().chain(&self.surface.out).map(|m| m.numbers.len()).sum();
        let mut words = vec![0; 3 * processes];
        let mine = [owned, solid.elements_of_share(), size_of::<f64>() * numbers];
        words[3 * me..][..3].copy_from_slice(&mine.map(|n| n as i64));
        self.ranks.add(&mut words);
        let size = |&[nodes, elements, sent]: &[i64; 3]| ShareSize {
            nodes: nodes as usize,
            elements: elements as usize,
            sent: sent as usize,
        };
        words.as_chunks().0.iter().map(size).collect()
    }

    fn leads(&self) -> bool {
        self.ranks.rank() == 0
    }

    /// Whether it owns a node.
    pub(crate) fn owns(&self, node: u32) -> bool {
        self.partition.owner(node) == self.ranks.rank()
    }

    /// How long it has waited for others in steps since this was last asked.
    pub(crate) fn take_waited(&mut self) -> Duration {
        std::mem::take(&mut self.waited)
    }

    /// To be called before a step.
    pub(crate) fn begin_step(&mut self, read: bool) {
        if self.leads() {
            self.ranks.tell(if read { STEP_AND_READ } else { STEP });
        }
        self.complete = false;
    }

    /// Before contact: the forces on the nodes of its surfaces, on their way to process 0, and there.
    pub(crate) fn send_forces(&mut self, force: &mut [Padded]) {
        let Mail { out, sent, into, received } = &mut self.surface;
        if self.ranks.rank() != 0 {
            for (message, nodes) in out.iter_mut().zip(sent) {
                let numbers = nodes.iter().flat_map(|&node| force[node as usize].xyz());
                message.numbers.iter_mut().zip(numbers).for_each(|(to, f)| *to = f);
            }
            return;
        }
        wait_for(&*self.ranks, &[], into, &mut self.waited, || ());
        for (message, nodes) in into.iter().zip(received) {
            for (f, &node) in message.numbers.as_chunks::<3>().0.iter().zip(&*nodes) {
                force[node as usize] = Padded::new(*f);
            }
        }
    }

    /// Has `advance` advance the nodes, chunk by chunk: those on the surfaces once contact has loaded them. Brings their velocities
    /// to those who read them, whose displacements follow from them in a step `dt` (s).
    pub(crate) fn advance(
        &mut self,
        nodes: &mut NodalState,
        contact: Option<&dyn Contact>,
        dt: f64,
        advance: impl Fn(&mut NodalState, &[bool]),
    ) {
        let Chunks { beside_contact, read_by_others, beside_halo } = &self.chunks;
        if let Some(contact) = contact {
            write_loaded(&mut self.surface.out, &mut self.addressed, contact, &nodes.force);
            wait_for(&*self.ranks, &self.surface.out, &mut [], &mut self.waited, || ());
            advance(nodes, beside_contact);
        } else {
            let Mail { out, into, .. } = &mut self.surface;
            wait_for(&*self.ranks, out, into, &mut self.waited, || advance(nodes, beside_contact));
            into.iter().for_each(|message| take_loaded(message, &mut nodes.force));
        }
        advance(nodes, read_by_others);
        let Mail { out, sent, into, received } = &mut self.halo;
        for (message, sent) in out.iter_mut().zip(sent) {
            let velocities = sent.iter().flat_map(|&n| nodes.velocity[n as usize].xyz());
            message.numbers.iter_mut().zip(velocities).for_each(|(to, v)| *to = v);
        }
        wait_for(&*self.ranks, out, into, &mut self.waited, || advance(nodes, beside_halo));
        for (message, received) in into.iter().zip(received) {
            for (v, &node) in message.numbers.as_chunks::<3>().0.iter().zip(&*received) {
                let (u, v) = (&mut nodes.displacement[node as usize], Padded::new(*v));
                (0..3).for_each(|i| u.0[i] += dt * v.0[i]);
                nodes.velocity[node as usize] = v;
            }
        }
        self.foreign.iter().for_each(|&node| nodes.force[node as usize] = Padded::ZERO);
    }

    /// The sums over all processes.
    pub(crate) fn add_up(&mut self, sums: &mut StepSums) {
        sums.write_words(&mut self.words);
        let begun = Instant::now();
        self.ranks.add(&mut self.words);
        self.waited += begun.elapsed();
        sums.take_words(&self.words);
    }

    /// A sum over all processes.
    pub(crate) fn add_up_one(&self, sum: &mut ExactSum) {
        let mut words = sum.words();
        self.ranks.add(&mut words);
        *sum = ExactSum::of_words(&words);
    }

    /// Brings displacements and velocities of all nodes to process 0.
    fn gather(&mut self, nodes: &mut NodalState) {
        if self.complete {
            return;
        }
        if self.leads() {
            self.ranks.tell(GATHER);
        }
        let (count, partition) = (nodes.inverse_mass.len(), &self.partition);
        let owned_by = |rank: usize| (0..count).filter(move |&n| partition.owner(n as u32) == rank);
        let (mut out, mut into) = (Vec::new(), Vec::new());
        if self.leads() {
            let message = |rank| Message { rank, numbers: vec![0.0; 6 * owned_by(rank).count()] };
            into = (1..self.ranks.size()).map(message).collect();
        } else {
            let motion = |n: usize| {
                let [[x, y, z], [vx, vy, vz]] =
                    [&nodes.displacement, &nodes.velocity].map(|f| f[n].xyz());
                [x, y, z, vx, vy, vz]
            };
            let numbers = owned_by(self.ranks.rank()).flat_map(motion).collect();
            out = vec![Message { rank: 0, numbers }];
        }
        self.ranks.exchange(&out, &mut into, &mut || ());
        for message in &into {
            let motions = message.numbers.as_chunks::<6>().0;
            for (n, &[x, y, z, vx, vy, vz]) in owned_by(message.rank).zip(motions) {
                nodes.displacement[n] = Padded::new([x, y, z]);
                nodes.velocity[n] = Padded::new([vx, vy, vz]);
            }
        }
        self.complete = true;
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        if self.leads() {
            self.ranks.tell(END);
        }
    }
}

impl Chunks {
    /// Those of process `me`, of whose nodes others read `read`, and some are on contact's `surfaces`.
    fn new<'a>(
        partition: &Partition,
        me: usize,
        read: impl Iterator<Item = &'a u32>,
        surfaces: &[u32],
    ) -> Self {
        let own: Vec<bool> = partition.owners.iter().map(|&owner| owner as usize == me).collect();
        let [mut on_surface, mut read_by_others] = [vec![false; own.len()], vec![false; own.len()]];
        read.for_each(|&node| read_by_others[node as usize / CHUNK] = true);
        surfaces.iter().for_each(|&node| on_surface[node as usize / CHUNK] = true);
        let chosen = |of: &dyn Fn(usize) -> bool| (0..own.len()).map(|c| own[c] && of(c)).collect();
        Self {
            beside_contact: chosen(&|c| !on_surface[c] && !read_by_others[c]),
            beside_halo: chosen(&|c| on_surface[c] && !read_by_others[c]),
            read_by_others: chosen(&|c| read_by_others[c]),
        }
    }
}

/// Has the elements be those of the nodes of process `rank`; returns their nodes that others own, and those of contact's
/// surfaces besides where that is the first.
fn take_elements(
    solid: &mut Solid,
    partition: &Partition,
    rank: usize,
    surfaces: Option<&Trace>,
) -> Vec<u32> {
    let own = |node: u32| partition.owner(node) == rank;
    solid.take_share(own);
    let mut touched = vec![false; solid.reference().len()];
    let read = surfaces.filter(|_| rank == 0).into_iter().flat_map(|trace| trace.read());
    solid.nodes_of_share().chain(read).for_each(|n| touched[n as usize] = true);
    (0..touched.len() as u32).filter(|&node| touched[node as usize] && !own(node)).collect()
}

/// Of so many nodes, whether each is among those of a hub.
fn carried<'a>(nodes: usize, hub: impl Iterator<Item = &'a u32>) -> Vec<bool> {
    let mut carried = vec![false; nodes];
    hub.for_each(|&n| carried[n as usize] = true);
    carried
}

/// [Exchanges](Ranks::exchange) messages, and adds to `waited` what that takes besides `beside`.
fn wait_for(
    ranks: &dyn Ranks,
    out: &[Message],
    into: &mut [Message],
    waited: &mut Duration,
    mut beside: impl FnMut(),
) {
    let begun = Instant::now();
    let mut busy = Duration::ZERO;
    ranks.exchange(out, into, &mut || {
        let begun = Instant::now();
        beside();
        busy += begun.elapsed();
    });
    *waited += begun.elapsed().saturating_sub(busy);
}

/// What a process does and sends in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShareSize {
    /// Nodes that it owns.
    pub nodes: usize,
    /// Elements that it computes, some of them others too.
    pub elements: usize,
    /// Bytes of velocities and of forces on contact's surfaces that it sends; of what contact loads the most that may be.
    pub sent: usize,
}

/// What each of so many processes would do and send by `partition`, where the hub carries the nodes `hub`, and contact is of
/// `surfaces`.
pub fn share_sizes(
    solid: &mut Solid,
    partition: &Partition,
    processes: usize,
    hub: &[u32],
    surfaces: &Trace,
) -> Vec<ShareSize> {
    let nodes = solid.reference().len();
    let carried = carried(nodes, hub.iter());
    let owned = by_owner(partition, processes, 0..nodes as u32);
    let on_surface = by_owner(partition, processes, surfaces.nodes().iter().copied());
    let mut sizes = vec![ShareSize::default(); processes];
    for rank in 0..processes {
        let foreign = take_elements(solid, partition, rank, Some(surfaces));
        sizes[rank].nodes = owned[rank].len();
        sizes[rank].elements = solid.elements_of_share();
        for &node in foreign.iter().filter(|&&node| !carried[node as usize]) {
            sizes[partition.owner(node)].sent += size_of::<f64>() * VECTORS(1);
        }
        if rank > 0 && !on_surface[rank].is_empty() {
            sizes[rank].sent += size_of::<f64>() * VECTORS(on_surface[rank].len());
            sizes[0].sent += size_of::<f64>() * LOADED(on_surface[rank].len());
        }
    }
    solid.take_all();
    sizes
}

/// Nodes by the process that owns them.
fn by_owner(
    partition: &Partition,
    processes: usize,
    nodes: impl Iterator<Item = u32>,
) -> Vec<Vec<u32>> {
    let mut of_each = vec![Vec::new(); processes];
    nodes.for_each(|node| of_each[partition.owner(node)].push(node));
    of_each
}

/// Writes the nodes that contact has loaded into the messages to their owners: how many, then of each its number and its force.
fn write_loaded(
    out: &mut [Message],
    addressed: &mut [(Option<usize>, bool)],
    contact: &dyn Contact,
    force: &[Padded],
) {
    for Message { numbers, .. } in &mut *out {
        numbers.clear();
        numbers.push(0.0);
    }
    // some come more than once
    for &loaded in contact.loaded() {
        if let (Some(message), written @ false) = &mut addressed[loaded as usize] {
            *written = true;
            let node = contact.trace().in_mesh(loaded);
            let [x, y, z] = force[node as usize].xyz();
            let numbers = &mut out[*message].numbers;
            numbers.extend([f64::from(node), x, y, z]);
            numbers[0] += 1.0;
        }
    }
    contact.loaded().iter().for_each(|&loaded| addressed[loaded as usize].1 = false);
}

/// Takes the forces that a message of [`write_loaded`] holds.
fn take_loaded(message: &Message, force: &mut [Padded]) {
    if let [count, loaded @ ..] = &message.numbers[..] {
        for &[node, x, y, z] in loaded.as_chunks::<4>().0.iter().take(*count as usize) {
            force[node as usize] = Padded::new([x, y, z]);
        }
    }
}

/// The nodes that each process wants from this one, which wants `wanted` from them.
fn asked_of(ranks: &dyn Ranks, wanted: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let others = || (0..ranks.size()).filter(|&rank| rank != ranks.rank());
    let message = |rank: usize, numbers| Message { rank, numbers };
    let out: Vec<_> = others().map(|r| message(r, vec![wanted[r].len() as f64])).collect();
    let mut counts: Vec<_> = others().map(|r| message(r, vec![0.0])).collect();
    ranks.exchange(&out, &mut counts, &mut || ());
    let numbers = |nodes: &[u32]| nodes.iter().map(|&n| f64::from(n)).collect();
    let out: Vec<_> = others().map(|r| message(r, numbers(&wanted[r]))).collect();
    let room = |m: &Message| message(m.rank, vec![0.0; m.numbers[0] as usize]);
    let mut into: Vec<_> = counts.iter().map(room).collect();
    ranks.exchange(&out, &mut into, &mut || ());
    let mut asked = vec![Vec::new(); ranks.size()];
    for message in into {
        asked[message.rank] = message.numbers.iter().map(|&n| n as u32).collect();
    }
    asked
}

impl Simulation {
    /// From now on takes the share of this process of the steps, by `partition`; returns what each process does. All processes must
    /// be in the same state. Process 0 goes on as if it were alone; the others [assist](Self::assist).
    ///
    /// The contact must not have paired nodes, the steps be explicit. Process 0 alone moves a mesh that follows the patch.
    pub fn take_share(&mut self, ranks: Arc<dyn Ranks>, partition: Partition) -> Vec<ShareSize> {
        let share = Share::new(ranks, partition, &mut self.system, &mut self.nodes);
        let sizes = share.sizes(&self.system.solid, self.nodes.inverse_mass.len());
        self.share = Some(share);
        sizes
    }

    /// Does as process 0 tells, until that ends its simulation.
    ///
    /// # Errors
    /// None but by a fault of the program: a state of process 0 that this one cannot be in.
    pub fn assist(&mut self) -> Result<(), RestoreError> {
        let mut taken = Ok(());
        loop {
            match self.share.as_ref().map(|share| share.ranks.tell(0)) {
                Some(STEP) => drop(self.step(false)),
                Some(STEP_AND_READ) => drop(self.step(true)),
                Some(GATHER) => self.gather(),
                // process 0 then ends the simulation too
                Some(TAKE_STATE) => taken = self.share_state(),
                _ => return taken,
            }
        }
    }

    /// Brings the state of process 0, which has all displacements and velocities, to the others.
    pub(crate) fn share_state(&mut self) -> Result<(), RestoreError> {
        let Some(ranks) = self.share.as_ref().map(|share| share.ranks.clone()) else {
            return Ok(());
        };
        let mut bytes = Vec::new();
        let mut taken = Ok(());
        if ranks.rank() == 0 {
            let state = SimulationState { contact: None, ..self.snapshot() };
            bytes = postcard::to_allocvec(&state)?;
            ranks.tell(TAKE_STATE);
            ranks.broadcast(&mut bytes);
        } else {
            ranks.broadcast(&mut bytes);
            let state: Result<SimulationState, _> = postcard::from_bytes(&bytes);
            taken = state.map_err(RestoreError::from).and_then(|state| self.restore(&state));
        }
        let all = ranks.all(taken.is_ok());
        if let Some(share) = &mut self.share {
            share.complete = true;
        }
        if all { Ok(()) } else { taken.and(Err(RestoreError::Process)) }
    }

    /// Brings displacements and velocities of all nodes to process 0. Between steps it has those of its own elements and of
    /// both contact surfaces.
    pub fn gather(&mut self) {
        if let Some(share) = &mut self.share {
            share.gather(&mut self.nodes);
        }
    }

    /// The same, and its elements are all of them again: for what is found at the end of a run.
    pub(crate) fn gather_for_good(&mut self) {
        self.gather();
        if self.share.is_some() {
            self.system.solid.take_all();
        }
    }
}
