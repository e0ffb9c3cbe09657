use super::*;

const STEP: f64 = 0.005;

/// Series of one number, `n` steps.
fn series(noise: Noise, seed: u64, n: usize) -> Vec<f64> {
    let space = BoxSpace::new(vec![-1.0; 3], vec![1.0; 3]);
    let mut noise = ActionNoise::new(noise, &space, STEP, seed);
    let mut action = Vec::new();
    (0..n)
        .map(|_| {
            noise.sample(&mut action);
            assert!(space.contains(&action), "{action:?}");
            f64::from(action[1])
        })
        .collect()
}

fn correlation(x: &[f64], lag: usize) -> f64 {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    let product = |lag: usize| {
        x.iter()
            .zip(&x[lag..])
            .map(|(a, b)| (a - mean) * (b - mean))
            .sum::<f64>()
    };
    product(lag) / product(0)
}

fn all() -> [Noise; 7] {
    [
        "white",
        "held",
        "ou",
        "pink",
        "color:0.69",
        "color_by_age:3",
        "oscillators",
    ]
    .map(|name| name.parse().unwrap())
}

#[test]
fn a_seed_gives_the_same_actions_and_another_seed_others() {
    for noise in all() {
        assert_eq!(series(noise, 7, 50), series(noise, 7, 50), "{noise}");
        assert_ne!(series(noise, 7, 50), series(noise, 8, 50), "{noise}");
        assert_eq!(noise.to_string().parse(), Ok(noise));
    }
}

#[test]
fn noises_are_alike_in_strength() {
    for noise in all() {
        // many seeds: an oscillator keeps its amplitude, and pink noise its mean, for a long time
        let power: f64 = (0..200)
            .map(|seed| series(noise, seed, 500).iter().map(|x| x * x).sum::<f64>() / 500.0)
            .sum();
        let deviation = (power / 200.0).sqrt();
        assert!((0.5..0.62).contains(&deviation), "{noise}: {deviation}");
    }
}

#[test]
fn each_noise_lasts_as_long_as_it_says() {
    let white = series(Noise::White, 0, 20_000);
    assert!(correlation(&white, 1).abs() < 0.03);
    let held = series(Noise::Held { seconds: 0.1 }, 0, 20_000);
    for (k, pair) in held.windows(2).enumerate() {
        assert_eq!(pair[0] == pair[1], (k + 1) % 20 != 0, "step {k}");
    }
    let ou = series(Noise::OrnsteinUhlenbeck { seconds: 0.1 }, 0, 200_000);
    let after = correlation(&ou, 20);
    assert!((after - pxfm::f_exp(-1.0)).abs() < 0.05, "{after}");
    let swinging = series(Noise::Oscillators { hertz: 2.0 }, 0, 4000);
    let crossings = swinging.windows(2).filter(|x| x[0] < 0.0 && x[1] >= 0.0).count();
    assert!((20..=60).contains(&crossings), "{crossings} periods in 20 s");
}

#[test]
fn the_power_of_pink_noise_falls_with_the_inverse_of_the_frequency() {
    let n = 4096;
    let power = |frequency: usize| {
        let mean = |seed| {
            let x = series(Noise::Pink, seed, n);
            let turn = TAU * frequency as f64 / n as f64;
            let wave = |f: fn(f64) -> f64| x.iter().enumerate().map(|(k, x)| x * f(turn * k as f64)).sum::<f64>();
            wave(f64::sin).powi(2) + wave(f64::cos).powi(2)
        };
        (0..120).map(mean).sum::<f64>()
    };
    let slope = (power(512) / power(8)).ln() / 64.0_f64.ln();
    assert!((slope + 1.0).abs() < 0.15, "{slope}");
}

/// Slope of the power over the frequency in Welch's periodograms of 1,024 steps, from 2 in 1,024 to a quarter of the steps.
fn exponent(noise: Noise, clipped: bool) -> f64 {
    const WINDOW: usize = 1024;
    let mut power = vec![0.0; WINDOW / 4 + 1];
    for seed in 0..6 {
        let x: Vec<f64> = if clipped {
            series(noise, seed, 1 << 15)
        } else {
            let mut process = ColoredNoise::new(noise.exponent().expect("a colour"), 3, seed);
            (0..1 << 15).map(|_| f64::from(process.next_values()[1])).collect()
        };
        for part in x.windows(WINDOW).step_by(WINDOW / 2) {
            let mean = part.iter().sum::<f64>() / WINDOW as f64;
            let hann = |k: usize| 0.5 - 0.5 * pxfm::f_cos(TAU * k as f64 / WINDOW as f64);
            let tapered: Vec<f64> = part.iter().enumerate().map(|(k, x)| (x - mean) * hann(k)).collect();
            for (sum, re_im) in power.iter_mut().zip(crate::spaces::spectrum::fourier(&tapered)) {
                *sum += re_im[0] * re_im[0] + re_im[1] * re_im[1];
            }
        }
    }
    let points: Vec<[f64; 2]> = power
        .iter()
        .enumerate()
        .skip(2)
        .map(|(k, p)| [(k as f64).ln(), p.ln()])
        .collect();
    let n = points.len() as f64;
    let [x, y] = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let (over, under) = points.iter().fold((0.0, 0.0), |(over, under), p| {
        (over + (p[0] - x) * (p[1] - y), under + (p[0] - x).powi(2))
    });
    -over / under
}

#[test]
fn colours_have_the_exponent_that_was_asked_for() {
    for asked in [0.0, 0.5, 0.69, 0.88, 1.0, 1.5, 2.0] {
        let noise = Noise::Color { exponent: asked };
        let [raw, clipped] = [false, true].map(|clipped| exponent(noise, clipped));
        assert!(
            (raw - asked).abs() < 0.02 && (clipped - asked).abs() < 0.02,
            "{asked}: {raw:.3}, clipped {clipped:.3}"
        );
    }
    let pink = exponent(Noise::Pink, true);
    assert!((pink - 1.14).abs() < 0.03, "pink: {pink:.3}");
}

#[test]
fn the_colour_of_an_age_is_held_outside_of_8_to_30_weeks() {
    let at = |months: f64| Noise::ColorByAge { months: Some(months) }.exponent().expect("a colour");
    assert!((at(0.0) - 0.6865).abs() < 1e-4 && (at(24.0) - 0.8777).abs() < 1e-4);
    assert!((at(4.6) - (0.617 + 0.00869 * 4.6 * 30.4375 / 7.0)).abs() < 1e-12);
    let open: Noise = "color_by_age".parse().expect("a noise");
    assert_eq!(open.at_age(Some(3.0)), "color_by_age:3".parse());
    assert!(open.at_age(None).is_err());
}

#[test]
fn what_is_no_noise_is_an_error_that_says_what_is() {
    for text in [
        "",
        "pinkish",
        "pink:1",
        "held:",
        "held:0",
        "held:-1",
        "ou:nan",
        "ou:inf",
        "oscillators:1e9",
        "white:2",
        "color",
        "color:2.1",
        "color:-0.1",
        "color_by_age:25",
    ] {
        let error = text.parse::<Noise>().unwrap_err().to_string();
        assert!(error.contains("pink") && error.contains("held:0.5"), "{error}");
    }
}
