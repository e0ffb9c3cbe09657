//! Acuity and foveation against pictures that NumPy computed from the published formulas.

use babybench::config::VisionOutputs;
use babybench::formats::npz::Npz;
use babybench::sensors::EyeImages;
use babybench::sensors::transform::{Acuity, AcuityOptions, Foveation, Signal, Transform, acuity_cutoff};
use babybench::spaces::NumpyRng;
use conformance::data;
use testkit::harness::Trial;
use testkit::{show, trials};

/// Height and width of the picture.
const SIZE: usize = 64;

pub fn trials() -> Vec<Trial> {
    trials![
        cutoffs_of_acuity_are_the_published_ones,
        transfer_functions_are_numpys,
        blurred_pictures_are_numpys,
        blurred_pictures_are_numpys_away_from_their_borders,
        foveated_pictures_are_numpys
    ]
}

fn acuity(age: f64, reference: bool) -> Acuity {
    let options = AcuityOptions {
        age,
        fovy: 60.0,
        reference,
    };
    Acuity::new(options, SIZE, SIZE)
}

/// Returns the picture after a transform.
fn transformed(archive: &Npz, transform: &mut dyn Transform) -> Vec<u8> {
    let mut images = EyeImages::new(VisionOutputs::default(), SIZE * SIZE);
    images.rgb = archive.get_u8("image").expect("a picture").data;
    let signal = Signal::Eye {
        images: &mut images,
        height: SIZE,
        width: SIZE,
    };
    transform.apply(signal, &mut NumpyRng::seed(0));
    images.rgb
}

/// Returns the largest difference of bytes, and how many differ.
fn apart(ours: &[u8], theirs: &[u8]) -> (u8, usize) {
    assert_eq!(ours.len(), theirs.len());
    let each = ours.iter().zip(theirs).map(|(a, b)| a.abs_diff(*b));
    (each.clone().max().unwrap_or(0), each.filter(|d| *d > 0).count())
}

fn cutoffs_of_acuity_are_the_published_ones() {
    let archive = data::npz("senses.npz");
    let array = |name: &str| archive.get_f64(name).expect(name).data;
    for (age, expect) in array("ages").into_iter().zip(array("acuity")) {
        let off = (acuity_cutoff(age) - expect).abs();
        show!("{age} months: {expect} cycles/degree, {off:.1e} off");
        assert!(off < 1e-14);
    }
}

fn transfer_functions_are_numpys() {
    let archive = data::npz("senses.npz");
    for age in [1, 6, 18] {
        let theirs = archive
            .get_f64(&format!("mtf_{age}"))
            .expect("a transfer function")
            .data;
        let ours = acuity(f64::from(age), false);
        let half = (SIZE / 2) as isize;
        let mut worst: f64 = 0.0;
        for (k, expect) in theirs.iter().enumerate() {
            let (v, u) = ((k / SIZE) as isize - half, (k % SIZE) as isize - half);
            worst = worst.max((ours.transfer(v, u) - expect).abs() / expect);
        }
        show!("{age} months: {worst:.1e} off");
        assert!(worst < 1e-14);
    }
}

/// Equal in every byte when written; a fraction next to a half may round the other way.
fn blurred_pictures_are_numpys() {
    let archive = data::npz("senses.npz");
    for age in [1, 6, 18] {
        let theirs = archive.get_u8(&format!("blur_{age}_u8")).expect("a picture").data;
        let ours = transformed(&archive, &mut acuity(f64::from(age), true));
        let (worst, differ) = apart(&ours, &theirs);
        show!(
            "{age} months: {worst} of 255 off at most, {differ} of {} bytes differ",
            ours.len()
        );
        assert!(worst <= 1 && differ < 10);
    }
}

/// Without what is near the borders, which NumPy's blur goes on across, ours differ little from the rounded pictures.
fn blurred_pictures_are_numpys_away_from_their_borders() {
    let archive = data::npz("senses.npz");
    for age in [1, 6, 18] {
        let theirs = archive.get_u8(&format!("blur_{age}_rounded")).expect("a picture").data;
        let ours = transformed(&archive, &mut acuity(f64::from(age), false));
        let mean = |inside: &dyn Fn(usize) -> bool| {
            let at = (0..SIZE * SIZE).filter(|k| inside(k / SIZE) && inside(k % SIZE));
            let off: Vec<f64> = at
                .flat_map(|k| (0..3).map(move |c| 3 * k + c))
                .map(|k| f64::from(ours[k].abs_diff(theirs[k])))
                .collect();
            off.iter().sum::<f64>() / off.len() as f64
        };
        let (middle, all) = (mean(&|at| (16..48).contains(&at)), mean(&|_| true));
        show!("{age} months: mean difference {middle:.2} of 255 in the middle, {all:.2} in all");
        assert!(middle < 2.0 && middle < all);
    }
}

/// As above.
fn foveated_pictures_are_numpys() {
    let archive = data::npz("senses.npz");
    for strength in [2, 10, 20] {
        let theirs = archive.get_u8(&format!("fovea_{strength}")).expect("a picture").data;
        let ours = transformed(&archive, &mut Foveation::new(f64::from(strength), SIZE, SIZE));
        let (worst, differ) = apart(&ours, &theirs);
        show!(
            "strength {strength}: {worst} of 255 off at most, {differ} of {} bytes differ",
            ours.len()
        );
        assert!(worst <= 1 && differ < 10);
    }
}
