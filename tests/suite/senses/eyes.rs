//! Acuity and foveation of single images.

use babybench::config::VisionOutputs;
use babybench::sensors::EyeImages;
use babybench::sensors::transform::{Acuity, AcuityOptions, Foveation, Signal, Transform, acuity_cutoff};
use babybench::spaces::NumpyRng;

/// A picture of random bytes.
fn picture(rng: &mut NumpyRng, height: usize, width: usize) -> EyeImages {
    let mut images = EyeImages::new(VisionOutputs::default(), height * width);
    images.rgb.iter_mut().for_each(|v| *v = (256.0 * rng.uniform()) as u8);
    images
}

fn apply(transform: &mut dyn Transform, images: &mut EyeImages, height: usize, width: usize) {
    transform.apply(Signal::Eye { images, height, width }, &mut NumpyRng::seed(0));
}

fn mean(image: &EyeImages) -> f64 {
    image.rgb.iter().map(|&v| f64::from(v)).sum::<f64>() / image.rgb.len() as f64
}

fn contrast(image: &EyeImages) -> f64 {
    let mean = mean(image);
    image.rgb.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum()
}

#[test]
fn acuity_keeps_the_mean_and_grows_with_age() {
    let mut rng = NumpyRng::seed(2);
    for (height, width) in [(64, 64), (48, 64), (31, 17), (1, 5)] {
        let image = picture(&mut rng, height, width);
        let mut before = 0.0;
        for age in [0.0, 1.0, 3.0, 9.0, 24.0, 36.0] {
            for reference in [false, true] {
                let options = AcuityOptions {
                    age,
                    fovy: 60.0,
                    reference,
                };
                let mut acuity = Acuity::new(options, height, width);
                let mut even = picture(&mut rng, height, width);
                even.rgb.fill(201);
                apply(&mut acuity, &mut even, height, width);
                assert!(even.rgb.iter().all(|v| *v == 201), "{height} x {width}: {:?}", even.rgb);
            }
            let mut blurred = image.clone();
            let options = AcuityOptions {
                age,
                fovy: 60.0,
                reference: false,
            };
            apply(&mut Acuity::new(options, height, width), &mut blurred, height, width);
            assert!((mean(&blurred) - mean(&image)).abs() < 1.0, "{age} months");
            let contrast = contrast(&blurred);
            assert!(
                (before..=self::contrast(&image)).contains(&contrast),
                "{height} x {width}, {age} months"
            );
            before = contrast;
        }
    }
    assert!((0..360).all(|k| acuity_cutoff(f64::from(k) / 10.0) <= acuity_cutoff(f64::from(k + 1) / 10.0)));
}

#[test]
fn acuity_does_not_reach_across_the_border() {
    let (height, width) = (64, 64);
    let bright_at_the_right = |reference: bool| {
        let mut images = EyeImages::new(VisionOutputs::default(), height * width);
        for (k, pixel) in images.rgb.chunks_exact_mut(3).enumerate() {
            pixel.fill(if k % width >= width - 4 { 255 } else { 0 });
        }
        let options = AcuityOptions {
            age: 0.0,
            fovy: 60.0,
            reference,
        };
        apply(&mut Acuity::new(options, height, width), &mut images, height, width);
        images.rgb[3 * (32 * width)]
    };
    // the authors' blur shows a ghost at the left border of what is at the right one
    assert!(bright_at_the_right(true) > 20, "{}", bright_at_the_right(true));
    assert!(bright_at_the_right(false) < 5, "{}", bright_at_the_right(false));
}

#[test]
fn foveation_enlarges_the_middle_and_keeps_the_corner() {
    let mut rng = NumpyRng::seed(3);
    for (height, width) in [(64, 64), (20, 33)] {
        let image = picture(&mut rng, height, width);
        let mut same = image.clone();
        apply(&mut Foveation::new(0.0, height, width), &mut same, height, width);
        assert_eq!(same, image, "strength 0 does nothing");
        for strength in [0.1, 2.0, 10.0, 1000.0] {
            let mut warped = image.clone();
            apply(&mut Foveation::new(strength, height, width), &mut warped, height, width);
            assert_eq!(warped.rgb[..3], image.rgb[..3], "the corner stays");
            let middle = 3 * ((height / 2) * width + width / 2);
            if height % 2 + width % 2 == 0 {
                assert_eq!(
                    warped.rgb[middle..middle + 3],
                    image.rgb[middle..middle + 3],
                    "the middle stays"
                );
            }
            let mut even = image.clone();
            even.rgb.fill(77);
            apply(&mut Foveation::new(strength, height, width), &mut even, height, width);
            assert!(even.rgb.iter().all(|v| *v == 77));
        }
    }
}
