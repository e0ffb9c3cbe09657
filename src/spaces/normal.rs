//! Normally distributed random numbers by the ziggurat method (G. Marsaglia and W. W. Tsang, "The Ziggurat Method for
//! Generating Random Variables", 2000, in the form of J. A. Doornik, 2005).
//!
//! Written here because the crates that have it (`rand_distr`) take `exp` and `ln` from the platform's mathematical library,
//! whose last bits differ between systems; `pxfm`'s are correctly rounded, so the noise of a seed is the same everywhere.

use std::sync::OnceLock;

/// Number of layers.
const LAYERS: usize = 128;
/// The start of the tail.
const TAIL: f64 = 3.442619855899;
/// Area of a layer.
const AREA: f64 = 9.91256303526217e-3;

/// Right edges of the layers from the bottom, and the share of each that is certainly under the curve.
struct ZigguratLayers {
    x: [f64; LAYERS + 1],
    share: [f64; LAYERS],
}

/// The density without its factor.
fn density(x: f64) -> f64 {
    pxfm::f_exp(-0.5 * x * x)
}

fn layers() -> &'static ZigguratLayers {
    static LAYERS_OF_ALL: OnceLock<ZigguratLayers> = OnceLock::new();
    LAYERS_OF_ALL.get_or_init(|| {
        let mut x = [0.0; LAYERS + 1];
        let mut f = density(TAIL);
        // the lowest layer includes the tail: as wide as a rectangle of the same area would be
        (x[0], x[1]) = (AREA / f, TAIL);
        for i in 2..LAYERS {
            x[i] = (-2.0 * pxfm::f_log(AREA / x[i - 1] + f)).sqrt();
            f = density(x[i]);
        }
        let share = std::array::from_fn(|i| x[i + 1] / x[i]);
        ZigguratLayers { x, share }
    })
}

/// Draws a number from the standard normal distribution. `word` returns 64 random bits.
pub(super) fn normal(mut word: impl FnMut() -> u64) -> f64 {
    let ZigguratLayers { x, share } = layers();
    loop {
        let bits = word();
        // the lowest 7 bits choose the layer, the highest 53 the place: they share none, or layers would have preferred
        // places (Doornik's correction of the original)
        let layer = bits as usize % LAYERS;
        let place = 2.0 * unit(bits) - 1.0;
        // inside the layer above as well, and so under the curve: 98 or 99 of 100 numbers end here
        if place.abs() < share[layer] {
            return place * x[layer];
        }
        if layer == 0 {
            return tail(&mut word, place < 0.0);
        }
        let at = place * x[layer];
        let (low, high) = (density(x[layer]), density(x[layer + 1]));
        // in the wedge between the layer and the curve: a height chosen at random decides
        if low + unit(word()) * (high - low) < density(at) {
            return at;
        }
    }
}

/// Draws from beyond [`TAIL`].
fn tail(word: &mut impl FnMut() -> u64, negative: bool) -> f64 {
    loop {
        // 1 - u is never 0
        let x = -pxfm::f_log(1.0 - unit(word())) / TAIL;
        let y = -pxfm::f_log(1.0 - unit(word()));
        // Marsaglia's exact tail: an exponential that is accepted with the right probability
        if 2.0 * y > x * x {
            return if negative { -(TAIL + x) } else { TAIL + x };
        }
    }
}

/// Converts the highest 53 bits to a number in [0, 1).
pub(super) fn unit(word: u64) -> f64 {
    (word >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
}
