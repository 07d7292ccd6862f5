//! The two roles: rank 0, which hands out chunks, counts and computes; and the others, which compute.

use std::path::Path;
use std::thread;

use guen_study::{Coordinator, PartReport, Summary, Sweep, SweepError};
use mpi::Rank;
use mpi::topology::{Communicator, SimpleCommunicator};

use crate::messages::{Answer, Order, Patience};
use crate::pool::Pool;
use crate::{Error, Share};

/// Ends all ranks when this one panics: they would wait for it for ever.
struct AbortOnPanic<'w>(&'w SimpleCommunicator);

/// The status of a program that has panicked.
const PANICKED: i32 = 101;

impl Drop for AbortOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.abort(PANICKED);
        }
    }
}

/// The work of rank 0.
pub(crate) fn first(sweep: &Sweep<'_>, folder: &Path, world: &SimpleCommunicator) -> Result<Share, Error> {
    let _guard = AbortOnPanic(world);
    let mut computed = 0;
    let whole = shared_out(sweep, folder, world, &mut computed);
    let failure = whole.as_ref().err().map(|error| match error {
        Error::Elsewhere { rank, cause } => (*rank, cause.clone()),
        own => (0, own.to_string()),
    });
    let end = Order::End(failure);
    others(world).for_each(|rank| end.send(world, rank));
    Ok(Share { computed, whole: Some(whole?) })
}

fn others(world: &SimpleCommunicator) -> std::ops::Range<Rank> {
    1..world.size()
}

/// Hands out and counts all chunks, and puts them together.
fn shared_out(
    sweep: &Sweep<'_>,
    folder: &Path,
    world: &SimpleCommunicator,
    computed: &mut u64,
) -> Result<(PartReport, Summary), Error> {
    let coordinator = sweep.coordinator(folder)?;
    let worker = sweep.worker(folder)?;
    others(world).for_each(|rank| Order::Begin.send(world, rank));
    let mut hub = Hub { world, coordinator, failed: None, present: others(world).len(), slots: 0 };
    Pool::beside(&worker, |pool| {
        let _guard = AbortOnPanic(world);
        *computed = hub.serve(pool, worker.threads());
    });
    drop(worker);
    let report = hub.coordinator.finish();
    if let Some(error) = hub.failed {
        return Err(error);
    }
    Ok((report?, sweep.merge([folder], folder)?))
}

/// The state of a run on rank 0, while chunks are computed.
struct Hub<'w> {
    world: &'w SimpleCommunicator,
    coordinator: Coordinator,
    failed: Option<Error>,
    /// The other ranks that have not left the folder yet.
    present: usize,
    /// The slots of all ranks that are not closed.
    slots: u64,
}

impl Hub<'_> {
    /// Works until all ranks have left and nothing is at work. Returns the number of chunks that were computed here.
    fn serve(&mut self, pool: &Pool, threads: usize) -> u64 {
        let mut computed = 0;
        self.slots = threads as u64;
        (0..threads).for_each(|_| self.next_here(pool));
        let mut patience = Patience::new();
        while self.present > 0 || self.slots > 0 {
            match pool.result(patience.pause()) {
                Some(Ok(finished)) => {
                    computed += 1;
                    self.count(&finished);
                    self.next_here(pool);
                    patience.renew();
                }
                Some(Err(error)) => {
                    self.fail(error.into());
                    self.slots -= 1;
                }
                None => {}
            }
            while let Some((rank, answer)) = Answer::receive(self.world) {
                self.hear(rank, answer);
                patience.renew();
            }
        }
        computed
    }

    fn hear(&mut self, rank: Rank, answer: Answer) {
        match answer {
            Answer::Ready(slots) => {
                self.slots += slots;
                (0..slots).for_each(|_| self.next(rank));
            }
            Answer::Finished(finished) => {
                self.count(&finished);
                self.next(rank);
            }
            Answer::Failed(cause) => {
                self.fail(Error::Elsewhere { rank, cause });
                self.slots -= 1;
            }
            Answer::Refused(cause) => {
                self.fail(Error::Elsewhere { rank, cause });
                self.present -= 1;
            }
            Answer::Left => self.present -= 1,
        }
    }

    /// The first error is told; afterwards no chunk is handed out.
    fn fail(&mut self, error: Error) {
        self.failed.get_or_insert(error);
    }

    fn count(&mut self, finished: &str) {
        if let Err(error) = self.coordinator.count(finished) {
            self.fail(error.into());
        }
    }

    fn assign(&mut self) -> Option<guen_study::Assignment> {
        if self.failed.is_some() { None } else { self.coordinator.assign() }
    }

    fn next(&mut self, rank: Rank) {
        match self.assign() {
            Some(assignment) => Order::Compute(assignment).send(self.world, rank),
            None => {
                Order::Close.send(self.world, rank);
                self.slots -= 1;
            }
        }
    }

    fn next_here(&mut self, pool: &Pool) {
        match self.assign() {
            Some(assignment) => pool.compute(assignment),
            None => self.slots -= 1,
        }
    }
}

/// The next order, waited for.
fn order(world: &SimpleCommunicator) -> Order {
    let mut patience = Patience::new();
    loop {
        if let Some(order) = Order::receive(world) {
            return order;
        }
        thread::sleep(patience.pause());
    }
}

/// The end of the run, waited for, where this rank has not failed itself.
fn end(order: Order, own: Option<SweepError>, share: Share) -> Result<Share, Error> {
    match (own, order) {
        (Some(error), _) => Err(error.into()),
        (None, Order::End(Some((rank, cause)))) => Err(Error::Elsewhere { rank, cause }),
        (None, _) => Ok(share),
    }
}

/// The work of every other rank.
pub(crate) fn other(sweep: &Sweep<'_>, folder: &Path, world: &SimpleCommunicator) -> Result<Share, Error> {
    let _guard = AbortOnPanic(world);
    let mut share = Share { computed: 0, whole: None };
    let begun = order(world);
    if begun != Order::Begin {
        return end(begun, None, share);
    }
    let own = match sweep.worker(folder) {
        Ok(worker) => {
            Answer::Ready(worker.threads() as u64).send(world);
            let failed = Pool::beside(&worker, |pool| {
                let _guard = AbortOnPanic(world);
                served(world, pool, worker.threads(), &mut share.computed)
            });
            // Whoever takes the folder next finds nobody at work.
            drop(worker);
            Answer::Left.send(world);
            failed
        }
        Err(error) => {
            Answer::Refused(error.to_string()).send(world);
            Some(error)
        }
    };
    end(order(world), own, share)
}

/// Computes until all slots are closed. Returns the first error.
fn served(
    world: &SimpleCommunicator,
    pool: &Pool,
    mut slots: usize,
    computed: &mut u64,
) -> Option<SweepError> {
    let mut failed = None;
    let mut patience = Patience::new();
    while slots > 0 {
        match pool.result(patience.pause()) {
            Some(Ok(finished)) => {
                *computed += 1;
                Answer::Finished(finished).send(world);
                patience.renew();
            }
            Some(Err(error)) => {
                Answer::Failed(error.to_string()).send(world);
                failed.get_or_insert(error);
                slots -= 1;
            }
            None => {}
        }
        while let Some(order) = Order::receive(world) {
            match order {
                Order::Compute(assignment) => pool.compute(assignment),
                Order::Close => slots -= 1,
                Order::Begin | Order::End(_) => unreachable!("slots are open"),
            }
            patience.renew();
        }
    }
    failed
}
