//! What the benches share.

pub mod by_hand;

use criterion::Criterion;
use fuzzy_core::Rng;
use std::time::Duration;

/// Short measurements in many rounds: on shared machines the minimum says more than the mean.
pub fn criterion() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .sample_size(30)
}

/// Positions of the evader, drawn evenly from the 18 m square around the pursuer.
pub fn positions(count: usize) -> Vec<(f64, f64)> {
    let mut rng = Rng::new(0, 0);
    (0..count).map(|_| (rng.uniform_in(-9.0, 9.0), rng.uniform_in(-9.0, 9.0))).collect()
}
