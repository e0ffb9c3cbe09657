//! Movements without a purpose: the noises with which models of infants babble and learners explore.

use std::f64::consts::{PI, TAU};
use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

use thiserror::Error;

use super::spectrum::ColoredNoise;
use super::{BoxSpace, NumpyRng};

/// Standard deviation of all noises before they are clipped, in half ranges of an action: that of uniform noise. Noises therefore differ in duration,
/// not in strength.
const DEVIATION: f64 = 0.577_350_269_189_625_8;
/// Number of processes whose sum is pink noise. The slowest lasts 2^11 steps, about as long as an episode.
const OCTAVES: usize = 12;
/// Strength of the coupling of oscillators, in natural frequencies. Above about 1.6 times the spread of the frequencies, oscillators start to
/// synchronise (Kuramoto, 1984). At this value, some do and some do not.
const COUPLING: f64 = 0.5;
/// Spread of the natural frequencies, as a share of their mean.
const SPREAD: f64 = 0.25;
/// Random walk of a phase within a second, rad: movements repeat, but never exactly.
const DRIFT: f64 = 0.5;

/// Exponents that [`Noise::Color`] may have. Beyond 2 the finite length of a block decides the spectrum.
const EXPONENTS: std::ops::RangeInclusive<f64> = 0.0..=2.0;
/// Exponent of infants' movements at birth, and its rise a week (arXiv 2606.16590: wrists and ankles of four infants of 8 to 30 weeks).
pub(crate) const INFANT_EXPONENT: [f64; 2] = [0.617, 0.00869];
/// Ages between which it was observed, weeks; it is constant before and after.
pub(crate) const INFANT_WEEKS: [f64; 2] = [8.0, 30.0];
/// Weeks of a month.
const WEEKS: f64 = 30.4375 / 7.0;

/// A kind of noise over an action space.
///
/// As text, `held:0.5` is [`Noise::Held`] with half a second; a name alone takes the default. Every noise but the uniform ones has
/// the standard deviation of uniform noise, 1/sqrt(3) of half the range of an action, and is clipped to the range.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Noise {
    /// `white`: a uniform action at every step, which is what `random` means elsewhere.
    White,
    /// `held`: a uniform action that is held for a time.
    Held {
        /// Duration for which an action is held, s; 0.5 by default.
        seconds: f64,
    },
    /// `ou`: an Ornstein-Uhlenbeck process for each number of the action, sampled exactly
    /// (D. T. Gillespie, "Exact numerical simulation of the Ornstein-Uhlenbeck process and its integral", 1996).
    OrnsteinUhlenbeck {
        /// The time in which the correlation falls to 1/e, s; 0.2 by default.
        seconds: f64,
    },
    /// `pink`: noise whose power falls about with the inverse of the frequency, between that of the step and one in 2^12 steps, which
    /// explores better than others in many tasks (O. Eberhard et al., "Pink noise is all you need", 2023). It is the sum of
    /// processes whose durations are octaves (J. Bernamont, 1937). Its exponent is 1.14 between a frequency of two in 1,024 steps and a
    /// quarter of the steps, and 1.03 between 0.5 and 10 Hz at steps of 5 ms; [`Noise::Color`] is exact.
    Pink,
    /// `color:0.69`: Gaussian noise whose power falls with that power of the frequency: 0 is white, 1 pink, 2 that of a random walk.
    ///
    /// The exponent is exact within 0.02, after clipping to the range of an action, between a frequency of two in 1,024 steps and a
    /// quarter of the steps: 0.4 to 50 Hz at steps of 5 ms. It is that of the actions; a body is a low pass, and its movements are redder.
    Color {
        /// The exponent, 0 to 2.
        exponent: f64,
    },
    /// `color_by_age:MONTHS`: [`Noise::Color`] with the exponent that was measured in the movements of infants of an age,
    /// 0.617 + 0.00869 a week between 8 and 30 weeks, held before and after (arXiv 2606.16590). Without a number, it is that of MIMo's
    /// age; see [`Noise::at_age`].
    ColorByAge {
        /// The age, months; `None` until [`Noise::at_age`] has set it.
        months: Option<f64>,
    },
    /// `oscillators`: an oscillator for each number of the action; all are coupled to their mean field (Y. Kuramoto, "Chemical
    /// Oscillations, Waves, and Turbulence", 1984), each with its own frequency, amplitude and phase.
    Oscillators {
        /// The mean of the frequencies, Hz; 1 by default.
        hertz: f64,
    },
}

/// A text that is not a noise, or an incomplete noise.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoiseError {
    /// The text is not a noise.
    #[error(
        "{text:?} is not a noise; choose white, held, ou, pink, color, color_by_age or oscillators, with a number where it may have one: \
         held:0.5 (seconds from 0.001 to 1000), ou:0.2 (seconds), color:0.69 (exponent from 0 to 2), color_by_age:3 (months from 0 to 24), \
         oscillators:1 (hertz)"
    )]
    Unknown {
        /// The text.
        text: String,
    },
    /// The noise of MIMo's age was requested, but no age is set.
    #[error("color_by_age is the noise of MIMo's age, and `age` is none; set `age`, or give months: color_by_age:3")]
    NoAge,
}

impl FromStr for Noise {
    type Err = NoiseError;

    fn from_str(text: &str) -> Result<Self, NoiseError> {
        let error = || NoiseError::Unknown { text: text.to_string() };
        let (name, number) = match text.split_once(':') {
            Some((name, number)) => (name, Some(number.parse::<f64>().map_err(|_| error())?)),
            None => (text, None),
        };
        // beyond these bounds a noise is another one: white, or a constant
        let valid = number.is_none_or(|n| match name {
            "color" => EXPONENTS.contains(&n),
            "color_by_age" => (0.0..=24.0).contains(&n),
            _ => (1e-3..=1e3).contains(&n),
        });
        match (name, number) {
            _ if !valid => Err(error()),
            ("white", None) => Ok(Self::White),
            ("held", seconds) => Ok(Self::Held {
                seconds: seconds.unwrap_or(0.5),
            }),
            ("ou", seconds) => Ok(Self::OrnsteinUhlenbeck {
                seconds: seconds.unwrap_or(0.2),
            }),
            ("pink", None) => Ok(Self::Pink),
            ("color", Some(exponent)) => Ok(Self::Color { exponent }),
            ("color_by_age", months) => Ok(Self::ColorByAge { months }),
            ("oscillators", hertz) => Ok(Self::Oscillators {
                hertz: hertz.unwrap_or(1.0),
            }),
            _ => Err(error()),
        }
    }
}

impl Display for Noise {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::White => f.write_str("white"),
            Self::Held { seconds } => write!(f, "held:{seconds}"),
            Self::OrnsteinUhlenbeck { seconds } => write!(f, "ou:{seconds}"),
            Self::Pink => f.write_str("pink"),
            Self::Color { exponent } => write!(f, "color:{exponent}"),
            Self::ColorByAge { months: None } => f.write_str("color_by_age"),
            Self::ColorByAge { months: Some(months) } => write!(f, "color_by_age:{months}"),
            Self::Oscillators { hertz } => write!(f, "oscillators:{hertz}"),
        }
    }
}

impl Noise {
    /// Returns the noise for MIMo at an age, months: `color_by_age` without a number gets that age. Other noises do not change.
    ///
    /// # Errors
    /// `color_by_age` without a number, and no age.
    pub fn at_age(self, age: Option<f64>) -> Result<Self, NoiseError> {
        match (self, age) {
            (Self::ColorByAge { months: None }, None) => Err(NoiseError::NoAge),
            (Self::ColorByAge { months: None }, age) => Ok(Self::ColorByAge { months: age }),
            _ => Ok(self),
        }
    }

    /// Returns the exponent of a noise of a given colour; `None` for others.
    pub fn exponent(self) -> Option<f64> {
        match self {
            Self::Color { exponent } => Some(exponent),
            Self::ColorByAge { months } => {
                let [first, last] = INFANT_WEEKS;
                // without an age the youngest that was seen
                let weeks = months.map_or(first, |months| (months * WEEKS).clamp(first, last));
                Some(INFANT_EXPONENT[0] + INFANT_EXPONENT[1] * weeks)
            }
            _ => None,
        }
    }
}

/// A noise over an action space: the same seed gives the same actions on every target.
///
/// ```
/// use babybench::spaces::{ActionNoise, BoxSpace};
///
/// let space = BoxSpace::new(vec![-1.0; 3], vec![1.0; 3]);
/// let mut noise = ActionNoise::new("pink".parse()?, &space, 0.005, 42); // a step of 5 ms
/// let mut action = Vec::new();
/// noise.sample(&mut action);
/// assert!(space.contains(&action));
/// # Ok::<(), babybench::spaces::NoiseError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ActionNoise {
    noise: Noise,
    space: BoxSpace,
    step: f64,
    rng: NumpyRng,
    process: NoiseProcess,
}

/// The memory of a noise from step to step.
#[derive(Clone, Debug)]
enum NoiseProcess {
    White,
    Held {
        action: Vec<f32>,
        left: usize,
    },
    /// Processes that fade by a factor each, (len, decays), whose sum is the noise.
    Relaxing {
        decays: Vec<f64>,
        values: Vec<f64>,
    },
    Colored(ColoredNoise),
    Oscillators(Vec<Oscillator>),
}

#[derive(Clone, Copy, Debug)]
struct Oscillator {
    phase: f64,
    /// Natural frequency, rad/s.
    speed: f64,
    amplitude: f64,
    /// Phase of the movement relative to the oscillator: otherwise, oscillators that swing together would move all joints in the same way.
    lag: f64,
}

impl ActionNoise {
    /// Creates a noise over a space. `step` is the time between two actions, s, which for an environment is
    /// [`Blueprint::dt`](crate::Blueprint::dt).
    pub fn new(noise: Noise, space: &BoxSpace, step: f64, seed: u64) -> Self {
        let mut made = Self {
            noise,
            space: space.clone(),
            step,
            rng: NumpyRng::seed(seed),
            process: NoiseProcess::White,
        };
        made.reset(seed);
        made
    }

    /// Restarts with a seed.
    pub fn reset(&mut self, seed: u64) {
        self.rng = NumpyRng::seed(seed);
        let (len, step, rng) = (self.space.len(), self.step, &mut self.rng);
        if let Some(exponent) = self.noise.exponent() {
            self.process = NoiseProcess::Colored(ColoredNoise::new(exponent, len, seed));
            return;
        }
        self.process = match self.noise {
            // colours have their process already
            Noise::White | Noise::Color { .. } | Noise::ColorByAge { .. } => NoiseProcess::White,
            Noise::Held { .. } => NoiseProcess::Held {
                action: Vec::with_capacity(len),
                left: 0,
            },
            Noise::OrnsteinUhlenbeck { seconds } => relaxing(vec![pxfm::f_exp(-step / seconds)], len, rng),
            Noise::Pink => {
                let octaves = (0..OCTAVES).map(|k| pxfm::f_exp(-1.0 / f64::from(1_u32 << k)));
                relaxing(octaves.collect(), len, rng)
            }
            Noise::Oscillators { hertz } => NoiseProcess::Oscillators(
                (0..len)
                    .map(|_| Oscillator {
                        phase: rng.uniform_in(0.0, TAU),
                        speed: TAU * hertz * pxfm::f_exp(SPREAD * rng.normal()),
                        // the mean of the squares is that of one: 2 * DEVIATION^2, of which a sine has half
                        amplitude: DEVIATION * std::f64::consts::SQRT_2 * (0.5 + rng.uniform())
                            / (13.0_f64 / 12.0).sqrt(),
                        lag: rng.uniform_in(0.0, TAU),
                    })
                    .collect(),
            ),
        };
    }

    /// Returns the kind.
    pub fn noise(&self) -> Noise {
        self.noise
    }

    /// Fills `action` with the next action.
    pub fn sample(&mut self, action: &mut Vec<f32>) {
        let Self {
            noise,
            space,
            step,
            rng,
            process,
        } = self;
        match process {
            NoiseProcess::White => space.sample(rng, action),
            NoiseProcess::Held { action: held, left } => {
                if *left == 0 {
                    space.sample(rng, held);
                    let seconds = match noise {
                        Noise::Held { seconds } => *seconds,
                        _ => 0.0,
                    };
                    *left = ((seconds / *step + 0.5) as usize).max(1);
                }
                *left -= 1;
                action.clone_from(held);
            }
            NoiseProcess::Relaxing { decays, values } => {
                let numbers = values.chunks_exact_mut(decays.len()).map(|values| {
                    let sum = values.iter().sum::<f64>();
                    for (value, decay) in values.iter_mut().zip(&*decays) {
                        *value = decay * *value + share(decays.len()) * (1.0 - decay * decay).sqrt() * rng.normal();
                    }
                    sum
                });
                place(space, numbers, action);
            }
            NoiseProcess::Colored(colored) => {
                let numbers = colored.next_values().iter().map(|value| DEVIATION * f64::from(*value));
                place(space, numbers, action);
            }
            NoiseProcess::Oscillators(all) => {
                let numbers = all.iter().map(|o| o.amplitude * pxfm::f_sin(o.phase + o.lag));
                place(space, numbers, action);
                let natural = match noise {
                    Noise::Oscillators { hertz } => TAU * *hertz,
                    _ => 0.0,
                };
                swing(all, natural, *step, rng);
            }
        }
    }
}

/// Standard deviation of each of `n` processes whose sum has that of all noises.
fn share(n: usize) -> f64 {
    DEVIATION / (n as f64).sqrt()
}

/// Starts processes in their stationary distribution, because a start from 0 would begin every episode with a pause.
fn relaxing(decays: Vec<f64>, len: usize, rng: &mut NumpyRng) -> NoiseProcess {
    let deviation = share(decays.len());
    let values = (0..len * decays.len()).map(|_| deviation * rng.normal()).collect();
    NoiseProcess::Relaxing { decays, values }
}

/// Advances oscillators by a step: the mean field pulls each towards the mean phase, more strongly the more they agree.
fn swing(all: &mut [Oscillator], natural: f64, step: f64, rng: &mut NumpyRng) {
    let mut field = [0.0; 2];
    for o in &*all {
        let (sin, cos) = pxfm::f_sincos(o.phase);
        field = [field[0] + cos, field[1] + sin];
    }
    let n = all.len().max(1) as f64;
    let pull = COUPLING * natural / n;
    for o in all {
        let (sin, cos) = pxfm::f_sincos(o.phase);
        let toward = field[1] * cos - field[0] * sin;
        o.phase += step * (o.speed + pull * toward) + DRIFT * step.sqrt() * rng.normal();
        // sines of large angles cost more and are not better
        if o.phase > PI {
            o.phase -= TAU;
        }
    }
}

/// Converts numbers in half ranges to an action.
fn place(space: &BoxSpace, numbers: impl Iterator<Item = f64>, action: &mut Vec<f32>) {
    action.clear();
    let bounds = space.low.iter().zip(&space.high);
    action.extend(bounds.zip(numbers).map(|((&low, &high), number)| {
        let (low, high) = (f64::from(low), f64::from(high));
        let value = 0.5 * (low + high) + 0.5 * (high - low) * number.clamp(-1.0, 1.0);
        value as f32
    }));
}

#[cfg(test)]
mod tests;
