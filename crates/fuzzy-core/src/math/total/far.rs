//! Angles that are many turns away, brought back without losing a digit (Payne & Hanek, 1983).

/// The first bits of 2/π behind the binary point, and 64 zeros before it.
const TWO_OVER_PI: [u64; 21] = [
    0,
    0xA2F9_836E_4E44_1529,
    0xFC27_57D1_F534_DDC0,
    0xDB62_9599_3C43_9041,
    0xFE51_63AB_DEBB_C561,
    0xB724_6E3A_424D_D2E0,
    0x0649_2EEA_09D1_921C,
    0xFE1D_EB1C_B129_A73E,
    0xE882_35F5_2EBB_4484,
    0xE99C_7026_B45F_7E41,
    0x3991_D639_8353_39F4,
    0x9C84_5F8B_BDF9_283B,
    0x1FF8_97FF_DE05_980F,
    0xEF2F_118B_5A0A_6D1F,
    0x6D36_7ECF_27CB_09B7,
    0x4F46_3F66_9E5F_EA2D,
    0x7527_BAC7_EBE5_F17B,
    0x3D07_39F7_8A52_92EA,
    0x6BFB_5FB1_1F8D_5D08,
    0x5603_3046_FC7B_6BAB,
    0xF0CF_BC20_9AF4_361D,
];

/// From here on these functions are meant; nearer, `trigonometric` reduces an angle faster.
pub(super) const FAR: f64 = 1_073_741_824.0; // 2³⁰

/// x = r + quadrant·π/2 up to whole turns, with |r| ≤ π/4, for a finite |x| ≥ [`FAR`]; otherwise
/// r is NaN.
pub(super) fn reduce(x: f64) -> (f64, f64) {
    if !(x.is_finite() && x.abs() >= FAR) {
        return (f64::NAN, 0.0);
    }
    let bits = x.abs().to_bits();
    let significand = bits & 0x000F_FFFF_FFFF_FFFF | 0x0010_0000_0000_0000;
    // |x| = significand·2ᵉ with e = exponent − 1075. Bits of 2/π above 2^(1 − e) make whole turns
    // only; the window begins there, 1013 places before the exponent in a table with 64 zeros.
    let exponent = (bits >> 52) as usize;
    let [high, middle, low] = times(significand, window(exponent - 1013));
    // Quarter turns modulo 4: two bits before the binary point, the rest behind it.
    let fraction = u128::from(high << 2 | middle >> 62) << 64 | u128::from(middle << 2 | low >> 62);
    // As a signed number the fraction lies in [−½, ½), and the quadrant is the nearest one.
    let fraction = fraction as i128;
    let quadrant = (high >> 62) as f64 + if fraction < 0 { 1.0 } else { 0.0 };
    let r = fraction as f64 * QUARTER_TURN;
    if x < 0.0 { (-r, -quadrant) } else { (r, quadrant) }
}

/// π/2 · 2⁻¹²⁸, the size of the fraction's last bit.
const QUARTER_TURN: f64 = std::f64::consts::FRAC_PI_2 * 2.938_735_877_055_719e-39;

/// The 192 bits of the table from this one on, high words first.
fn window(first: usize) -> [u64; 3] {
    std::array::from_fn(|index| {
        let word = first / 64 + index;
        let pair = u128::from(TWO_OVER_PI[word]) << 64 | u128::from(TWO_OVER_PI[word + 1]);
        (pair << (first % 64) >> 64) as u64
    })
}

/// The product modulo 2¹⁹².
fn times(factor: u64, [high, middle, low]: [u64; 3]) -> [u64; 3] {
    let wide = |word: u64, carry: u128| u128::from(factor) * u128::from(word) + carry;
    let low = wide(low, 0);
    let middle = wide(middle, low >> 64);
    let high = wide(high, middle >> 64);
    [high as u64, middle as u64, low as u64]
}
