//! The same work for many things, by all cores.

/// What `work` makes of each item, in their order. At most `most` threads work, of which the calling one
/// is one; 0 means as many as there are cores. A browser's page has one.
#[cfg(not(target_arch = "wasm32"))]
pub fn map_all<T: Sync, R: Send>(
    items: &[T],
    most: usize,
    work: impl Fn(&T) -> R + Sync,
) -> Vec<R> {
    use std::sync::atomic::{AtomicUsize, Ordering};

    let cores = || std::thread::available_parallelism().map_or(1, Into::into);
    let threads = if most == 0 { cores() } else { most };
    let next = AtomicUsize::new(0);
    let take = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else {
                return done;
            };
            done.push((index, work(item)));
        }
    };
    let mut done = std::thread::scope(|scope| {
        let others = 1..threads.min(items.len());
        // Where no thread can be had, those that there are do its share.
        let others =
            others.map_while(|_| std::thread::Builder::new().spawn_scoped(scope, take).ok());
        let others: Vec<_> = others.collect();
        let mut done = take();
        for other in others {
            match other.join() {
                Ok(theirs) => done.extend(theirs),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        done
    });
    done.sort_unstable_by_key(|&(index, _)| index);
    done.into_iter().map(|(_, made)| made).collect()
}

/// What `work` makes of each item, in their order.
#[cfg(target_arch = "wasm32")]
pub fn map_all<T, R>(items: &[T], _most: usize, work: impl Fn(&T) -> R) -> Vec<R> {
    items.iter().map(work).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_order_at_any_number_of_threads() {
        let items: Vec<usize> = (0..1000).collect();
        for most in [0, 1, 2, 7, 5000] {
            let squares = map_all(&items, most, |&item| item * item);
            assert!(
                squares
                    .iter()
                    .enumerate()
                    .all(|(i, &square)| square == i * i)
            );
        }
        assert!(map_all(&[], 0, |&item: &usize| item).is_empty());
    }
}
