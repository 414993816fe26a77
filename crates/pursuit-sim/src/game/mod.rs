//! Games: who plays, how a step is made, when it ends.

pub mod many_on_many;
pub mod one_on_one;
pub mod prospect;
pub mod two_pursuers;
pub mod wall;
pub mod wall_following;
