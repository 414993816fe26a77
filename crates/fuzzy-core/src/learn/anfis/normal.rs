//! The normal equations of an output's consequents, added up in lanes.
//!
//! A row of the design matrix is s ⊗ (x; 1) with the shares s of the conclusions, so the product of
//! two conclusions' parts is sₜsᵤ·(x; 1)(x; 1)ᵀ: one product of shares for all of it, and each
//! product of inputs is taken once for all conclusions.

use std::array::from_fn;

use crate::check;
use crate::error::Result;
use crate::inference::ConsequentSlot;
use crate::math::{LANES, Lanes, Real};

/// Blocks of eight samples that are added together, so that sums stay in registers.
const BLOCKS: usize = 16;
type Column = [Lanes; BLOCKS];

/// The sums AᵀA and Aᵀf of one output.
#[derive(Debug, Clone)]
pub(super) struct Normal {
    slots: Vec<ConsequentSlot>,
    unknowns: usize,
    filled: usize,
    shares: Vec<Column>,
    /// The inputs and 1; only 1 if all conclusions are constants.
    factors: Vec<Column>,
    /// The products of two factors, the first no later than the second.
    products: Vec<Column>,
    targets: Column,
    /// For each pair of conclusions, the first no later than the second, a sum for each product.
    gram: Vec<Lanes>,
    /// For each conclusion a sum for each factor.
    rhs: Vec<Lanes>,
}

impl Normal {
    /// The sums over no samples.
    pub fn new(slots: Vec<ConsequentSlot>) -> Result<Self> {
        let factors = slots.iter().map(|slot| slot.count).max().unwrap_or(1);
        let (products, pairs) = (triangular(factors), triangular(slots.len()));
        let zero = Lanes::splat(0.0);
        // Asking for the memory first: a grid of many terms may have too many rules.
        check::zeros("the normal equations of the consequents", LANES * pairs, products)?;
        let mut normal = Self {
            unknowns: slots.iter().map(|slot| slot.count).sum(),
            filled: 0,
            shares: vec![[zero; BLOCKS]; slots.len()],
            factors: vec![[zero; BLOCKS]; factors],
            products: vec![[zero; BLOCKS]; products],
            targets: [zero; BLOCKS],
            gram: vec![zero; pairs * products],
            rhs: vec![zero; slots.len() * factors],
            slots,
        };
        normal.factors[factors - 1] = [Lanes::splat(1.0); BLOCKS];
        Ok(normal)
    }

    /// Where the unknowns stand in the parameter vector, in their order.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        self.slots.iter().flat_map(|slot| slot.place..slot.place + slot.count)
    }

    /// The conclusions.
    pub fn slots(&self) -> &[ConsequentSlot] {
        &self.slots
    }

    /// The number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Adds eight samples; shares are zero in lanes that don't count.
    pub fn add(&mut self, x: &[Lanes], shares: &[Lanes], target: Lanes) {
        let block = self.filled;
        for (column, &share) in self.shares.iter_mut().zip(shares) {
            column[block] = share;
        }
        let inputs = self.factors.len() - 1;
        for (column, &input) in self.factors[..inputs].iter_mut().zip(x) {
            column[block] = input;
        }
        self.targets[block] = target;
        self.filled += 1;
        if self.filled == BLOCKS {
            self.sum_up();
        }
    }

    /// Adds the blocks to the sums.
    fn sum_up(&mut self) {
        let zero = Lanes::splat(0.0);
        for column in &mut self.shares {
            column[self.filled..].fill(zero);
        }
        self.filled = 0;
        let mut sums = self.gram.as_mut_slice();
        if self.factors.len() == 1 {
            for (first, share) in self.shares.iter().enumerate() {
                let (own, others) = sums.split_at_mut(self.shares.len() - first);
                add_dots(share, &self.shares[first..], own);
                sums = others;
            }
        } else {
            let factors = &self.factors;
            let pairs = (0..factors.len()).flat_map(|i| (i..factors.len()).map(move |j| (i, j)));
            for (product, (i, j)) in self.products.iter_mut().zip(pairs) {
                *product = times(&factors[i], &factors[j]);
            }
            for (first, share) in self.shares.iter().enumerate() {
                for other in &self.shares[first..] {
                    let (own, others) = sums.split_at_mut(self.products.len());
                    add_dots(&times(share, other), &self.products, own);
                    sums = others;
                }
            }
        }
        for (share, sums) in self.shares.iter().zip(self.rhs.chunks_exact_mut(self.factors.len())) {
            add_dots(&times(share, &self.targets), &self.factors, sums);
        }
    }

    /// AᵀA, row by row, and Aᵀf over all samples that were added; begins anew.
    pub fn take(&mut self) -> Result<(Vec<f64>, Vec<f64>)> {
        self.sum_up();
        let (count, last) = (self.unknowns, self.factors.len() - 1);
        let mut gram = check::zeros("the normal matrix of the consequents", count, count)?;
        let mut rhs = Vec::with_capacity(count);
        // Of the factors a constant has the last one only.
        let first_factor = |slot: &ConsequentSlot| last + 1 - slot.count;
        let total = |sum: &Lanes| sum.to_array().iter().sum::<f64>();
        let mut sums = self.gram.chunks_exact(self.products.len());
        let mut row = 0;
        for (index, slot) in self.slots.iter().enumerate() {
            let mut column = row;
            for (other, sums) in self.slots[index..].iter().zip(&mut sums) {
                for i in first_factor(slot)..=last {
                    for j in first_factor(other)..=last {
                        let (low, high) = (i.min(j), i.max(j));
                        let product =
                            triangular(last + 1) - triangular(last + 1 - low) + high - low;
                        let place =
                            (row + i - first_factor(slot), column + j - first_factor(other));
                        gram[place.0 * count + place.1] = total(&sums[product]);
                    }
                }
                column += other.count;
            }
            let own = &self.rhs[index * (last + 1)..][..=last];
            rhs.extend(own[first_factor(slot)..].iter().map(total));
            row += slot.count;
        }
        self.gram.fill(Lanes::splat(0.0));
        self.rhs.fill(Lanes::splat(0.0));
        Ok((gram, rhs))
    }
}

/// 1 + 2 + … + n.
fn triangular(n: usize) -> usize {
    n * (n + 1) / 2
}

#[inline(always)]
fn times(a: &Column, b: &Column) -> Column {
    from_fn(|block| a[block] * b[block])
}

/// Adds the products of a column with each of many to their sums.
#[inline(always)]
fn add_dots(column: &Column, mut others: &[Column], mut sums: &mut [Lanes]) {
    // So many sums fit into registers.
    const MANY: usize = 6;
    const SOME: usize = 3;
    while let (Some(some), Some(own)) = (others.first_chunk(), sums.first_chunk_mut()) {
        dots::<MANY>(column, some, own);
        (others, sums) = (&others[MANY..], &mut sums[MANY..]);
    }
    while let (Some(some), Some(own)) = (others.first_chunk(), sums.first_chunk_mut()) {
        dots::<SOME>(column, some, own);
        (others, sums) = (&others[SOME..], &mut sums[SOME..]);
    }
    for (other, own) in others.iter().zip(sums.chunks_exact_mut(1)) {
        if let Some(own) = own.first_chunk_mut() {
            dots::<1>(column, &[*other], own);
        }
    }
}

#[inline(always)]
fn dots<const K: usize>(column: &Column, others: &[Column; K], sums: &mut [Lanes; K]) {
    let mut own = *sums;
    for (block, &value) in column.iter().enumerate() {
        for (sum, other) in own.iter_mut().zip(others) {
            *sum = value.mul_add(other[block], *sum);
        }
    }
    *sums = own;
}
