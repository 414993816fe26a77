//! What the benches share.

use criterion::Criterion;
use std::time::Duration;

/// Short measurements in many rounds: on shared machines the minimum says more than the mean.
pub fn criterion() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .sample_size(30)
}
