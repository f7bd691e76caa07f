//! Timing several trials side by side.
//!
//! The speed of a shared machine drifts by tens of percent within seconds, so that two figures that
//! were measured one after the other cannot be compared. Here one round runs every trial once, and
//! a ratio is the median of the ratios within rounds: both of its sides saw the same machine.

use std::time::{Duration, Instant};

use anyhow::Result;

/// A card's clock has settled when three runs of one trial are as close as this.
const STEADY: f64 = 1.05;
/// How many times the warm-up it may take. A clock that never settles shows in the ranges.
const PATIENCE: u32 = 8;

/// How often and on how much to measure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Timed runs of everything.
    pub(crate) rounds: usize,
    /// Lookups a run on the GPU.
    pub(crate) gpu_lookups: usize,
    /// Lookups a run on the CPU.
    pub(crate) cpu_lookups: usize,
    /// How long to run everything unmeasured at least.
    pub(crate) warm_up: Duration,
    /// When to begin no more files.
    pub(crate) deadline: Option<Instant>,
}

impl Effort {
    /// Whether the deadline has passed.
    pub(crate) fn is_over(&self) -> bool {
        self.deadline
            .is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// [`interleave`] after the warm-up, which goes on while the first trial's time still changes.
    pub(crate) fn interleave(&self, mut trials: Vec<Trial<'_>>) -> Result<Vec<Timing>> {
        let start = Instant::now();
        let mut latest = [f64::INFINITY, 0.0, 0.0];
        let is_steady = |latest: &[f64; 3]| {
            let spread = Spread::of(latest.iter().copied());
            spread.max <= STEADY * spread.min
        };
        while start.elapsed() < self.warm_up
            || !is_steady(&latest) && start.elapsed() < PATIENCE * self.warm_up
        {
            for (index, trial) in trials.iter_mut().enumerate() {
                let seconds = (trial.run)()?.as_secs_f64();
                if index == 0 {
                    latest = [seconds, latest[0], latest[1]];
                }
            }
        }
        interleave(trials, self.rounds)
    }
}

/// One thing to time.
pub(crate) struct Trial<'a> {
    items: f64,
    run: Box<dyn FnMut() -> Result<Duration> + 'a>,
}

impl<'a> Trial<'a> {
    /// A trial that measures its own time and does `items` lookups, rays or the like per run.
    pub(crate) fn timed(items: usize, run: impl FnMut() -> Result<Duration> + 'a) -> Self {
        Self {
            items: items as f64,
            run: Box::new(run),
        }
    }
}

/// Seconds of one trial, one value per round. Timings from one call of [`interleave`] have the same
/// rounds.
#[derive(Clone, Debug)]
pub(crate) struct Timing {
    items: f64,
    seconds: Vec<f64>,
}

impl Timing {
    /// Millions of items a second.
    pub(crate) fn millions_a_second(&self) -> Spread {
        Spread::of(
            self.seconds
                .iter()
                .map(|seconds| self.items / seconds / 1e6),
        )
    }

    /// Milliseconds a run.
    pub(crate) fn milliseconds(&self) -> Spread {
        Spread::of(self.seconds.iter().map(|seconds| seconds * 1e3))
    }

    /// How many times as fast as `base`, per item.
    pub(crate) fn speed_against(&self, base: &Self) -> Spread {
        let pairs = self.seconds.iter().zip(&base.seconds);
        Spread::of(pairs.map(|(own, other)| (self.items / own) / (base.items / other)))
    }
}

/// Median and range of repeated measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    pub(crate) median: f64,
    pub(crate) min: f64,
    pub(crate) max: f64,
}

impl Spread {
    /// All fields are NaN when there are no values.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().saturating_sub(1);
        // The lower and upper middle are the same element when the count is odd.
        let middle = values.get(last / 2).zip(values.get(last.div_ceil(2)));
        Self {
            median: middle.map_or(f64::NAN, |(low, high)| (low + high) / 2.0),
            min: values.first().copied().unwrap_or(f64::NAN),
            max: values.last().copied().unwrap_or(f64::NAN),
        }
    }
}

/// Runs every trial once unmeasured (caches warm, shaders compiled), then `rounds` times in turn.
pub(crate) fn interleave(mut trials: Vec<Trial<'_>>, rounds: usize) -> Result<Vec<Timing>> {
    for trial in &mut trials {
        (trial.run)()?;
    }
    let mut seconds = vec![Vec::with_capacity(rounds); trials.len()];
    for _ in 0..rounds {
        for (trial, seconds) in trials.iter_mut().zip(&mut seconds) {
            seconds.push((trial.run)()?.as_secs_f64());
        }
    }
    let timings = trials.into_iter().zip(seconds);
    Ok(timings
        .map(|(trial, seconds)| Timing {
            items: trial.items,
            seconds,
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_of_odd_and_even_counts() {
        let odd = Spread::of([3.0, 1.0, 2.0].into_iter());
        assert_eq!(
            odd,
            Spread {
                median: 2.0,
                min: 1.0,
                max: 3.0
            }
        );
        assert_eq!(Spread::of([4.0, 1.0, 2.0, 3.0].into_iter()).median, 2.5);
        assert!(Spread::of(std::iter::empty()).median.is_nan());
    }

    #[test]
    fn ratios_are_taken_within_rounds() {
        let timing = |seconds: [f64; 3]| Timing {
            items: 10.0,
            seconds: seconds.to_vec(),
        };
        // The machine is ten times slower in the second round; the ratio does not see it.
        let fast = timing([1.0, 10.0, 1.0]);
        let slow = timing([2.0, 20.0, 2.0]);
        assert_eq!(
            fast.speed_against(&slow),
            Spread {
                median: 2.0,
                min: 2.0,
                max: 2.0
            }
        );
    }

    #[test]
    fn trials_run_in_turn_after_a_warm_up() {
        let log = std::cell::RefCell::new(String::new());
        let trial = |name: &'static str| {
            let log = &log;
            Trial::timed(1, move || {
                log.borrow_mut().push_str(name);
                Ok(Duration::ZERO)
            })
        };
        let timings = interleave(vec![trial("a"), trial("b")], 2).unwrap();
        assert_eq!(log.into_inner(), "ababab");
        assert_eq!(timings[1].seconds.len(), 2);
    }
}
