//! The time of a thread on a processor. A file of its own: `guen-expansion-timing`, which depends on no system, has it too.

/// Seconds that this thread has spent on a processor, whatever else the machine did; NaN where the system does not tell.
pub fn processor_time() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split(' ').next().and_then(|first| first.parse::<f64>().ok());
    nanoseconds.map_or(f64::NAN, |nanoseconds| nanoseconds * 1e-9)
}
