//! Work in parts, several at a time, whose results are handed out as they come; the first error ends the work.
//! It depends on neither cases nor rows.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Does `one` for each part, `workers` at a time, in no fixed order.
///
/// # Errors
/// The last error of `one`; after an error no further part is begun.
pub fn each<T: Sync, E: Send>(
    parts: &[T],
    workers: usize,
    one: &(dyn Fn(&T) -> Result<(), E> + Sync),
) -> Result<(), E> {
    let next = AtomicUsize::new(0);
    let failed: Mutex<Option<E>> = Mutex::new(None);
    std::thread::scope(|scope| {
        for _ in 0..workers.max(1) {
            scope.spawn(|| {
                while let Some(part) = parts.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Err(e) = one(part) {
                        // The other workers stop too.
                        next.store(parts.len(), Ordering::Relaxed);
                        *failed.lock().unwrap_or_else(PoisonError::into_inner) = Some(e);
                    }
                }
            });
        }
    });
    failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_done_once_and_an_error_ends_the_work() {
        let parts: Vec<usize> = (0..100).collect();
        let done = Mutex::new(Vec::new());
        each(&parts, 3, &|p| {
            done.lock().unwrap().push(*p);
            Ok::<(), String>(())
        })
        .unwrap();
        let mut done = done.into_inner().unwrap();
        done.sort_unstable();
        assert_eq!(done, parts);

        let begun = AtomicUsize::new(0);
        let fails = |p: &usize| {
            begun.fetch_add(1, Ordering::Relaxed);
            if *p == 4 { Err(format!("part {p}")) } else { Ok(()) }
        };
        assert_eq!(each(&parts, 1, &fails), Err("part 4".to_owned()));
        assert_eq!(begun.into_inner(), 5);
    }
}
