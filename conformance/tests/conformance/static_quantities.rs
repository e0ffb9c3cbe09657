//! Quantities that follow from a state without advancing it, and one step, against MuJoCo 3.3.0 for all six models.

use conformance::measure::{line, only_print};
use conformance::reference::Reference;
use conformance::statics::{Compared, States, constants};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        quantities_without_constraints_equal_mujocos,
        constants_of_the_model_equal_mujocos,
        contacts_and_constraint_rows_are_as_many_as_mujocos,
        quantities_with_constraints_are_near_mujocos
    ]
}

fn print(name: &str, q: &Compared) {
    show!(
        "{name:9} {:15} {}  bit-identical {} of {}",
        q.name,
        q.summary(),
        q.identical,
        q.values
    );
}

/// The worst were 3.3e-16 for poses, 2.8e-14 for forces and 5.6e-15 for the acceleration when written.
fn quantities_without_constraints_equal_mujocos() {
    for reference in Reference::all() {
        let name = &reference.name;
        for q in States::new(&reference).smooth {
            print(name, &q);
            assert!(
                only_print() || q.summary().max <= 2e-13,
                "{name}: {} {}",
                q.name,
                q.summary()
            );
        }
    }
}

/// The worst was 1.7e-14 when written.
fn constants_of_the_model_equal_mujocos() {
    for reference in Reference::all() {
        let errors = constants(&reference);
        show!("{:9} {}", reference.name, line(&errors));
        for (name, error) in errors {
            assert!(only_print() || error <= 1e-13, "{}: {name} {error:e}", reference.name);
        }
    }
}

fn contacts_and_constraint_rows_are_as_many_as_mujocos() {
    for reference in Reference::all() {
        let counts = States::new(&reference).counts;
        show!("{:9} (contacts), (rows), ours and MuJoCo's: {counts:?}", reference.name);
        let same = counts.iter().flatten().all(|(ours, theirs)| ours == theirs);
        assert!(only_print() || same, "{}: {counts:?}", reference.name);
    }
}

/// The worst medians were 3.8e-12 for the acceleration and 5.4e-11 for forces, the worst velocity 1.4e-8 when written.
fn quantities_with_constraints_are_near_mujocos() {
    for reference in Reference::all() {
        let name = &reference.name;
        for q in States::new(&reference).constrained {
            print(name, &q);
            let s = q.summary();
            let good = if q.name == "next_qvel" {
                s.max <= 1e-7
            } else {
                s.p50 <= 5e-10
            };
            assert!(only_print() || good, "{name}: {} {s}", q.name);
        }
    }
}
