//! Labels in pictures: numbers with their units, drawn in strokes.

/// Height of capitals and figures in the units of the glyphs.
const CAP: f32 = 10.0;
/// Space between two glyphs.
const SPACE: f32 = 1.7;
/// Points for each part of a curve.
const FINE: usize = 6;

/// A stroke: straight from point to point, or a curve through all of them, which may be closed.
enum Stroke {
    Line(&'static [[f32; 2]]),
    Curve(&'static [[f32; 2]]),
    Ring(&'static [[f32; 2]]),
}

use Stroke::{Curve, Line, Ring};

/// The strokes of a character from the baseline upwards, and its width.
fn glyph(character: char) -> (&'static [Stroke], f32) {
    const ROUND: Stroke = Ring(&[[2.9, 0.0], [0.4, 3.5], [2.9, 7.0], [5.4, 3.5]]);
    match character {
        '0' => (
            &[Ring(&[
                [3.0, 0.0],
                [0.6, 2.8],
                [0.6, 7.2],
                [3.0, 10.0],
                [5.4, 7.2],
                [5.4, 2.8],
            ])],
            6.0,
        ),
        '1' => (&[Line(&[[0.6, 8.0], [3.0, 10.0], [3.0, 0.0]])], 4.4),
        '2' => (
            &[
                Curve(&[
                    [0.5, 7.4],
                    [1.3, 9.4],
                    [3.0, 10.0],
                    [5.0, 9.1],
                    [5.3, 6.9],
                    [3.6, 3.9],
                    [0.4, 0.0],
                ]),
                Line(&[[0.4, 0.0], [5.7, 0.0]]),
            ],
            6.0,
        ),
        '3' => (
            &[
                Curve(&[[0.6, 8.6], [2.8, 10.0], [5.0, 8.9], [4.9, 6.5], [2.5, 5.4]]),
                Curve(&[[2.5, 5.4], [5.0, 4.6], [5.6, 2.4], [4.3, 0.5], [2.3, 0.0], [0.4, 1.3]]),
            ],
            6.0,
        ),
        '4' => (&[Line(&[[4.4, 0.0], [4.4, 10.0], [0.2, 3.0], [6.0, 3.0]])], 6.2),
        '5' => (
            &[
                Line(&[[5.2, 10.0], [1.2, 10.0], [0.8, 5.6]]),
                Curve(&[[0.8, 5.6], [3.2, 6.3], [5.3, 4.9], [5.4, 1.9], [3.0, 0.0], [0.4, 1.2]]),
            ],
            6.0,
        ),
        '6' => (
            &[
                Curve(&[[4.9, 9.6], [2.2, 8.2], [0.6, 5.2], [0.5, 3.0]]),
                Ring(&[[3.0, 0.0], [0.5, 3.0], [3.0, 6.0], [5.5, 3.0]]),
            ],
            6.0,
        ),
        '7' => (&[Line(&[[0.4, 10.0], [5.6, 10.0], [2.0, 0.0]])], 6.0),
        '8' => (
            &[
                Ring(&[[3.0, 5.4], [0.9, 7.7], [3.0, 10.0], [5.1, 7.7]]),
                Ring(&[[3.0, 0.0], [0.5, 2.7], [3.0, 5.4], [5.5, 2.7]]),
            ],
            6.0,
        ),
        '9' => (
            &[
                Ring(&[[3.0, 4.0], [0.5, 7.0], [3.0, 10.0], [5.5, 7.0]]),
                Curve(&[[5.5, 7.0], [5.4, 4.8], [3.8, 1.8], [1.1, 0.4]]),
            ],
            6.0,
        ),
        'm' => (
            &[
                Line(&[[0.5, 0.0], [0.5, 7.0]]),
                Curve(&[[0.5, 4.6], [1.3, 6.4], [2.6, 7.0], [3.9, 6.2], [4.2, 4.4]]),
                Line(&[[4.2, 4.4], [4.2, 0.0]]),
                Curve(&[[4.2, 4.6], [5.0, 6.4], [6.3, 7.0], [7.6, 6.2], [7.9, 4.4]]),
                Line(&[[7.9, 4.4], [7.9, 0.0]]),
            ],
            8.4,
        ),
        'n' => (
            &[
                Line(&[[0.5, 0.0], [0.5, 7.0]]),
                Curve(&[[0.5, 4.4], [1.5, 6.3], [3.0, 7.0], [4.5, 6.2], [5.0, 4.2]]),
                Line(&[[5.0, 4.2], [5.0, 0.0]]),
            ],
            5.5,
        ),
        'h' => (
            &[
                Line(&[[0.5, 0.0], [0.5, 10.0]]),
                Curve(&[[0.5, 4.4], [1.5, 6.3], [3.0, 7.0], [4.5, 6.2], [5.0, 4.2]]),
                Line(&[[5.0, 4.2], [5.0, 0.0]]),
            ],
            5.5,
        ),
        'o' => (&[ROUND], 5.8),
        't' => (
            &[
                Line(&[[1.9, 9.2], [1.9, 1.7]]),
                Curve(&[[1.9, 1.7], [2.3, 0.4], [3.2, 0.0], [4.0, 0.2]]),
                Line(&[[0.2, 7.0], [3.9, 7.0]]),
            ],
            4.0,
        ),
        's' => (
            &[Curve(&[
                [4.7, 5.9],
                [2.8, 7.0],
                [0.9, 6.1],
                [1.0, 4.3],
                [2.8, 3.5],
                [4.8, 2.6],
                [4.8, 0.8],
                [2.6, 0.0],
                [0.4, 1.2],
            ])],
            5.2,
        ),
        'c' => (
            &[Curve(&[
                [5.0, 5.9],
                [3.2, 7.0],
                [1.0, 5.9],
                [0.4, 3.5],
                [1.0, 1.1],
                [3.2, 0.0],
                [5.0, 1.1],
            ])],
            5.2,
        ),
        'k' => (
            &[
                Line(&[[0.5, 0.0], [0.5, 10.0]]),
                Line(&[[4.6, 7.0], [0.5, 2.9]]),
                Line(&[[2.0, 4.4], [4.9, 0.0]]),
            ],
            5.0,
        ),
        'g' => (
            &[
                ROUND,
                Line(&[[5.4, 7.0], [5.4, -0.8]]),
                Curve(&[[5.4, -0.8], [4.6, -2.5], [2.7, -3.0], [0.8, -2.2]]),
            ],
            5.9,
        ),
        '.' => (&[Line(&[[0.6, 0.25], [0.7, 0.25]])], 1.3),
        _ => (&[], 2.2),
    }
}

/// Returns the width of a label with letters of a height, pixels.
pub(super) fn width(text: &str, height: f32) -> f32 {
    let units: f32 = text.chars().map(|c| glyph(c).1 + SPACE).sum();
    (units - SPACE).max(0.0) * height / CAP
}

/// Calls `ink` with each pixel that a label covers and how much, 0 to 1. The label begins at `left` on the line `baseline`.
pub(super) fn letter(text: &str, [left, baseline]: [f32; 2], height: f32, mut ink: impl FnMut(i32, i32, f32)) {
    let scale = height / CAP;
    let half = 0.52 * scale; // half the width of a stroke
    let mut x = left;
    for character in text.chars() {
        let (strokes, advance) = glyph(character);
        let lines: Vec<Vec<[f32; 2]>> = strokes
            .iter()
            .map(|stroke| {
                let place = |[u, v]: [f32; 2]| [x + scale * u, baseline - scale * v];
                path(stroke).into_iter().map(place).collect()
            })
            .collect();
        if !lines.is_empty() {
            let columns = (x - 2.0) as i32..=(x + scale * advance + 2.0) as i32;
            let rows = (baseline - 1.1 * height) as i32..=(baseline + 0.45 * height) as i32;
            for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
                let at = [column as f32 + 0.5, row as f32 + 0.5];
                let near = lines
                    .iter()
                    .flat_map(|line| line.windows(2))
                    .map(|ends| distance(at, ends[0], ends[1]));
                let cover = (half + 0.5 - near.fold(f32::INFINITY, f32::min)).clamp(0.0, 1.0);
                if cover > 0.0 {
                    ink(column, row, cover);
                }
            }
        }
        x += scale * (advance + SPACE);
    }
}

/// Returns a stroke as straight pieces.
fn path(stroke: &Stroke) -> Vec<[f32; 2]> {
    let (points, closed) = match stroke {
        Line(points) => return points.to_vec(),
        Curve(points) => (points, false),
        Ring(points) => (points, true),
    };
    let n = points.len();
    let at = |k: isize| {
        if closed {
            points[k.rem_euclid(n as isize) as usize]
        } else {
            points[k.clamp(0, n as isize - 1) as usize]
        }
    };
    let pieces = if closed { n } else { n - 1 };
    let mut out = vec![at(0)];
    for k in 0..pieces as isize {
        let [a, b, c, d] = [at(k - 1), at(k), at(k + 1), at(k + 2)];
        out.extend((1..=FINE).map(|step| {
            let t = step as f32 / FINE as f32;
            // through b and c with the direction from neighbour to neighbour (Catmull and Rom)
            std::array::from_fn(|i| {
                let (a, b, c, d) = (a[i], b[i], c[i], d[i]);
                b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
            })
        }));
    }
    out
}

/// Returns the distance of a point from a straight piece.
fn distance([x, y]: [f32; 2], [ax, ay]: [f32; 2], [bx, by]: [f32; 2]) -> f32 {
    let (dx, dy) = (bx - ax, by - ay);
    let length = dx * dx + dy * dy;
    let along = if length > 0.0 {
        (((x - ax) * dx + (y - ay) * dy) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let (u, v) = (x - ax - along * dx, y - ay - along * dy);
    (u * u + v * v).sqrt()
}
