//! Several pieces of work on several threads.

use std::num::NonZeroUsize;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Does `work` for every item on several threads (absent: as many as there are processors), begun in
/// order; the results are in that order too.
///
/// Plain threads that take the next item from a queue: an item is seconds to hours of work, and a
/// pool that splits the list in halves would begin with the first and the middle one.
pub fn in_parallel<I: Sync, T: Send>(
    items: &[I],
    threads: Option<NonZeroUsize>,
    work: impl Fn(&I) -> T + Sync,
) -> Vec<T> {
    let available = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.map_or_else(available, usize::from).min(items.len());
    let next = AtomicUsize::new(0);
    let take_items = || {
        let mut done = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(number) else {
                return done;
            };
            done.push((number, work(item)));
        }
    };
    let mut results: Vec<(usize, T)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(take_items)).collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap_or_else(|panic| resume_unwind(panic)))
            .collect()
    });
    results.sort_by_key(|(number, _)| *number);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_items() {
        let items: Vec<usize> = (0..100).collect();
        let squares = in_parallel(&items, NonZeroUsize::new(3), |k| k * k);
        assert!(
            squares
                .iter()
                .enumerate()
                .all(|(k, square)| *square == k * k)
        );
        assert!(in_parallel(&[] as &[usize], None, |k| *k).is_empty());
    }
}
