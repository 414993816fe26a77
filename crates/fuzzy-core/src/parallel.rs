//! Independent pieces of work on several threads.
//!
//! Each call has its own pool: nothing outlives it, so a process may fork before and after. The
//! pieces are cut by the caller, never by the number of threads, and results come in their
//! order; this is what makes them independent of the number of threads.

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

use crate::error::{Error, Result};

/// Applies `work` to every item on up to `threads` threads (0: one for each core), in order.
///
/// The first error in the items' order is returned.
pub fn map<T, U, E>(
    threads: usize,
    items: Vec<T>,
    work: impl Fn(T) -> Result<U, E> + Sync + Send,
) -> Result<Vec<U>, E>
where
    T: Send,
    U: Send,
    E: From<Error> + Send,
{
    let threads = match threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        some => some,
    };
    if threads == 1 || items.len() <= 1 {
        return items.into_iter().map(work).collect();
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads.min(items.len()))
        .build()
        .map_err(|error| Error::Threads { threads, reason: error.to_string() })?;
    let results: Vec<Result<U, E>> =
        pool.install(|| items.into_par_iter().with_max_len(1).map(work).collect());
    results.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_first_error_do_not_depend_on_the_threads() {
        for threads in [0, 1, 2, 7] {
            let squares = map(threads, (0..100).collect(), |i: u64| Ok::<_, Error>(i * i)).unwrap();
            assert!(squares.iter().enumerate().all(|(i, &s)| s == (i * i) as u64));
            let failed = map(threads, (0..100).collect(), |i: u64| {
                if i % 10 == 3 {
                    Err(Error::unknown_name("item", &i.to_string(), []))
                } else {
                    Ok(i)
                }
            });
            assert!(failed.unwrap_err().to_string().contains("\"3\""));
        }
    }
}
