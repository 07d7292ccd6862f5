//! Threads with room for what is asked on them.

/// Steppers keep all that they need on the stack, DOP853 some 150 states; of twenty links over duals with forty directions that
/// is two megabytes, which is all that threads have by default.
const STACK: usize = 16 << 20;

/// Does the work on so many threads, and on this one where none can be started.
pub fn on_threads(threads: usize, work: impl Fn() + Sync) {
    std::thread::scope(|scope| {
        for _ in 0..threads {
            if std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, &work).is_err() {
                work();
            }
        }
    });
}
