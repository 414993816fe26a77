//! Numbers that formulas are written over: one `f64`, or eight in lock-step.

use std::ops::{Add, BitAnd, Div, Mul, Neg, Sub};

use bytemuck::cast;
use wide::{f64x8, u64x8};

/// The number of lanes of [`Lanes`].
pub const LANES: usize = 8;

/// A real number for formulas that must give the same bits alone and in a batch.
///
/// Comparisons give a mask and decisions are taken by [`Real::select`]; there is no branching on
/// values, so eight lanes can take eight different decisions. `a.lt(b)` and its kin are false
/// when either side is NaN, as in IEEE 754.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Send
    + Sync
    + 'static
{
    /// The result of a comparison, lane by lane.
    type Mask: Copy + BitAnd<Output = Self::Mask>;

    /// The same value in every lane.
    fn splat(value: f64) -> Self;
    /// `self · factor + addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// The absolute value.
    fn abs(self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The nearest integer, ties to even.
    fn round(self) -> Self;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `chosen` where the mask holds, `otherwise` elsewhere.
    fn select(mask: Self::Mask, chosen: Self, otherwise: Self) -> Self;
    /// 2ⁿ for an integral value in −1022..=1023; anything else gives an arbitrary number.
    fn exp2_integer(self) -> Self;
    /// Splits a positive normal number into (m, n) with self = m·2ⁿ and m in [√½, √2).
    fn split_exponent(self) -> (Self, Self);
    /// Sine and cosine of an angle from those of the angle less `quadrant` quarter turns, an
    /// integral number.
    fn turn_quadrant(sine: Self, cosine: Self, quadrant: Self) -> (Self, Self);
    /// The value with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// A scalar function of two numbers, lane by lane; for table look-ups.
    fn zip_with(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self;
    /// Replaces one lane (the value itself for a scalar).
    fn set_lane(&mut self, lane: usize, value: f64);

    /// The same numbers as plain ones, if they are: one point may be worked on in other ways than
    /// many, as long as the bits are the same.
    #[inline(always)]
    fn plain(numbers: &[Self]) -> Option<&[f64]> {
        let _ = numbers;
        None
    }

    /// The smaller of two numbers; `other` when `self` is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// The larger of two numbers; `other` when `self` is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// The value held within ±`limit`; NaN stays NaN.
    #[inline(always)]
    fn clamp_symmetric(self, limit: f64) -> Self {
        self.clamp_within(Self::splat(limit))
    }

    /// The same with a limit of each lane's own.
    #[inline(always)]
    fn clamp_within(self, limit: Self) -> Self {
        let low = -limit;
        Self::select(self.lt(low), low, Self::select(limit.lt(self), limit, self))
    }

    /// c₀ + c₁x + c₂x² + …, the even and the odd terms apart, each by Horner's rule with fused
    /// multiply-adds: two short chains of operations instead of a long one.
    #[inline(always)]
    fn polynomial(self, coefficients: &[f64]) -> Self {
        let square = self * self;
        let horner = |first: usize| {
            let mut terms = coefficients.iter().skip(first).step_by(2).rev();
            let highest = Self::splat(terms.next().copied().unwrap_or(0.0));
            terms.fold(highest, |sum, &c| sum.mul_add(square, Self::splat(c)))
        };
        horner(1).mul_add(self, horner(0))
    }
}

/// Adding this to a small integer puts the integer into the low bits of the significand.
const INTEGER_SHIFT: f64 = 6_755_399_441_055_744.0; // 1.5 · 2⁵²
const EXPONENT_BIAS: f64 = 1023.0;
const SQRT_HALF_BITS: u64 = 0x3FE6_A09E_667F_3BCD;

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        f64::mul_add(self, factor, addend)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn round(self) -> Self {
        f64::round_ties_even(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, chosen: Self, otherwise: Self) -> Self {
        if mask { chosen } else { otherwise }
    }
    #[inline(always)]
    fn exp2_integer(self) -> Self {
        f64::from_bits((self + (INTEGER_SHIFT + EXPONENT_BIAS)).to_bits() << 52)
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        // Subtracting √½ as an integer makes the exponent field count from the wanted interval.
        let offset = self.to_bits().wrapping_sub(SQRT_HALF_BITS);
        let exponent = offset & 0xFFF0_0000_0000_0000;
        let mantissa = f64::from_bits(self.to_bits().wrapping_sub(exponent));
        (mantissa, ((exponent as i64) >> 52) as f64)
    }
    #[inline(always)]
    fn turn_quadrant(sine: Self, cosine: Self, quadrant: Self) -> (Self, Self) {
        // Odd quadrants swap the two; the second bit of the quadrant, or of the next, is the sign.
        let bits = (quadrant + INTEGER_SHIFT).to_bits();
        let (first, second) = if bits & 1 == 1 { (cosine, sine) } else { (sine, cosine) };
        let signed = |value: f64, bits: u64| f64::from_bits(value.to_bits() ^ ((bits & 2) << 62));
        (signed(first, bits), signed(second, bits.wrapping_add(1)))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f64::copysign(self, sign)
    }
    #[inline(always)]
    fn zip_with(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        function(self, other)
    }
    #[inline(always)]
    fn set_lane(&mut self, _lane: usize, value: f64) {
        *self = value;
    }
    #[inline(always)]
    fn plain(numbers: &[Self]) -> Option<&[f64]> {
        Some(numbers)
    }
}

/// Eight numbers that go through the same operations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes(f64x8);

impl Lanes {
    /// Lanes with these values.
    #[inline(always)]
    pub fn new(values: [f64; LANES]) -> Self {
        Self(f64x8::new(values))
    }

    /// The values of the lanes.
    #[inline(always)]
    pub fn to_array(self) -> [f64; LANES] {
        self.0.to_array()
    }

    /// Bit i is set where the mask holds in lane i.
    #[inline(always)]
    pub fn bits(mask: LaneMask) -> u32 {
        mask.0.to_bitmask()
    }
}

/// The comparison of two [`Lanes`].
#[derive(Clone, Copy, Debug)]
pub struct LaneMask(f64x8);

impl BitAnd for LaneMask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

macro_rules! lanewise {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}
lanewise!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for Lanes {
    type Mask = LaneMask;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(f64x8::splat(value))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn round(self) -> Self {
        Self(self.0.round_ties_even())
    }
    #[inline(always)]
    fn lt(self, other: Self) -> LaneMask {
        LaneMask(self.0.simd_lt(other.0))
    }
    #[inline(always)]
    fn le(self, other: Self) -> LaneMask {
        LaneMask(self.0.simd_le(other.0))
    }
    #[inline(always)]
    fn select(mask: LaneMask, chosen: Self, otherwise: Self) -> Self {
        Self(mask.0.select(chosen.0, otherwise.0))
    }
    // The instructions of x86 decide as the trait's definitions do, also for NaN and signed zeros;
    // those of other processors don't.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.fast_min(other.0))
    }
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.fast_max(other.0))
    }
    #[inline(always)]
    fn exp2_integer(self) -> Self {
        let shifted: u64x8 = cast(self.0 + f64x8::splat(INTEGER_SHIFT + EXPONENT_BIAS));
        Self(cast(shifted << 52_u32))
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        // Used outside hot loops only; the scalar form is the definition.
        let parts = self.to_array().map(Real::split_exponent);
        (
            Self::new(parts.map(|(mantissa, _)| mantissa)),
            Self::new(parts.map(|(_, exponent)| exponent)),
        )
    }
    #[inline(always)]
    fn turn_quadrant(sine: Self, cosine: Self, quadrant: Self) -> (Self, Self) {
        let bits: u64x8 = cast(quadrant.0 + f64x8::splat(INTEGER_SHIFT));
        // A blend looks at the sign bit only.
        let odd: f64x8 = cast(bits << 63_u32);
        let (first, second) = (odd.select(cosine.0, sine.0), odd.select(sine.0, cosine.0));
        let signed = |value: f64x8, bits: u64x8| {
            let sign: f64x8 = cast((bits & u64x8::splat(2)) << 62_u32);
            Self(value ^ sign)
        };
        (signed(first, bits), signed(second, bits + u64x8::splat(1)))
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let sign_bit = f64x8::splat(-0.0);
        Self((sign.0 & sign_bit) | self.0.abs())
    }
    #[inline(always)]
    fn zip_with(self, other: Self, function: impl Fn(f64, f64) -> f64) -> Self {
        let (left, right) = (self.to_array(), other.to_array());
        Self::new(std::array::from_fn(|lane| function(left[lane], right[lane])))
    }
    #[inline(always)]
    fn set_lane(&mut self, lane: usize, value: f64) {
        self.0.as_mut_array()[lane] = value;
    }
}
