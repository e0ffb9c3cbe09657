//! The section about touched parts.

use maud::{Markup, html};

use super::{HANDS, percent};
use crate::report::doll::{self, Doll, DollSide};
use crate::report::run::RunContents;
use crate::report::svg::embed;
use babybench::assets::{DirAssets, Overlay};
use babybench::eval::TouchableGeoms;
use babybench::mimo::embedded;
use babybench::model::Model;

/// Share of the full colour for the parts that the hand touches least.
const FAINT: f32 = 0.3;
/// Number of parts that are always listed; the others can be unfolded.
const LISTED: usize = 10;
/// Parts that can be touched, parts that cannot, the palm itself.
const PLAIN: [f32; 3] = [0.87, 0.87, 0.89];
const OUT_OF_REACH: [f32; 3] = [0.72, 0.73, 0.76];
const PALM: [f32; 3] = [0.25, 0.28, 0.34];

/// For each hand the geoms that it touched, with the share of episodes in which it did.
type TouchedGeoms = [Vec<(usize, f64)>; 2];
/// A geom, and for each hand the share of episodes in which it touched the geom.
type TouchShare = (usize, [f64; 2]);

/// Draws the section: MIMo with touched parts in colour, and a table of the parts.
pub(super) fn touch_section(run: &mut RunContents) -> Markup {
    let touched = run.touched();
    let (Some(model), Some(touchables)) = (&run.model, &run.touchables) else {
        run.notices
            .push("Touched parts are not drawn: the run's scene has no MIMo that this program recognises.".to_string());
        return html! {};
    };
    let dolls = dolls(run, model, touchables, &touched);
    let source = match run.counted() {
        [] => "evaluation",
        _ => "training",
    };
    let (some, none) = parts(model, touchables, &touched);
    html! {
        section {
            h2 { "What the hands touched" }
            p { "In " (source) ": the stronger the colour, the more episodes with a touch. Dark: the touching palm. "
                "Grey: out of its reach." }
            (dolls)
            @if !some.is_empty() { (parts_table(touchables, &some[..some.len().min(LISTED)])) }
            @if some.len() > LISTED {
                details {
                    summary { (some.len() - LISTED) " more parts" }
                    (parts_table(touchables, &some[LISTED..]))
                }
            }
            @if !none.is_empty() {
                details {
                    summary { (none.len()) " parts that neither hand has touched yet" }
                    p { @for (k, (geom, _)) in none.iter().enumerate() {
                        @if k > 0 { ", " } (touchables.name(*geom).replace('_', " ")) } }
                }
            }
        }
    }
}

/// Draws MIMo from both sides for each hand.
fn dolls(run: &RunContents, model: &Model, touchables: &TouchableGeoms, touched: &TouchedGeoms) -> Markup {
    let assets = DirAssets::new(&run.dir).ok();
    let mut doll = match assets {
        Some(assets) => Doll::new(model, &Overlay::new(embedded()).with(assets)),
        None => Doll::new(model, &embedded()),
    };
    let palms = ["right_hand", "left_hand"].map(|name| model.body(name));
    let mut picture = |hand: usize, side: DollSide| -> Option<String> {
        let color = |g: usize| {
            if Some(model.geom_bodyid[g]) == palms[hand] {
                return PALM;
            }
            match touched[hand].iter().find(|(geom, _)| *geom == g) {
                Some((_, share)) => mix(PLAIN, HANDS[hand].2, FAINT + (1.0 - FAINT) * share.sqrt() as f32),
                None if touchables.reachable(hand).contains(&g) => PLAIN,
                None => OUT_OF_REACH,
            }
        };
        Some(embed("png", &doll.as_mut()?.draw(side, &color)?))
    };
    let pictures = [0, 1].map(|hand| [DollSide::Front, DollSide::Back].map(|side| (side, picture(hand, side))));
    html! {
        div.dolls {
            @for (hand, sides) in pictures.iter().enumerate() {
                figure {
                    div.pair {
                        @for (side, picture) in sides {
                            @if let Some(picture) = picture {
                                img src=(picture) width=(doll::WIDTH) height=(doll::HEIGHT)
                                    alt=(format!("MIMo from the {}, parts touched by the {} in colour",
                                        if *side == DollSide::Front { "front" } else { "back" }, HANDS[hand].0));
                            }
                        }
                    }
                    figcaption.(HANDS[hand].1) {
                        b { (HANDS[hand].0) } ", from the front and from the back: "
                        (touched[hand].len()) " of " (touchables.reachable(hand).len()) " parts in reach"
                    }
                }
            }
        }
    }
}

/// Returns the parts in reach of a hand, the most often touched first, and those that no hand has touched.
fn parts(model: &Model, touchables: &TouchableGeoms, touched: &TouchedGeoms) -> (Vec<TouchShare>, Vec<TouchShare>) {
    let share = |g: usize, hand: usize| {
        let found = touched[hand].iter().find(|(t, _)| *t == g);
        found.map_or(0.0, |(_, share)| *share)
    };
    let mut parts: Vec<TouchShare> = (0..model.ngeom())
        .filter(|g| [0, 1].iter().any(|&hand| touchables.reachable(hand).contains(g)))
        .map(|g| (g, [0, 1].map(|hand| share(g, hand))))
        .collect();
    parts.sort_by(|a, b| (b.1[0] + b.1[1]).total_cmp(&(a.1[0] + a.1[1])));
    parts.into_iter().partition(|(_, s)| s[0] + s[1] > 0.0)
}

/// Mixes two colours.
fn mix(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

/// Draws the table of touches, by hand and part.
fn parts_table(touchables: &TouchableGeoms, parts: &[TouchShare]) -> Markup {
    html! {
        table.bars {
            thead { tr { th { "part" } th { "share of episodes" } th.number { "right" } th.number { "left" } } }
            @for (geom, shares) in parts {
                tr {
                    th { (touchables.name(*geom).replace('_', " ")) }
                    td.wide {
                        @for (hand, share) in shares.iter().enumerate() {
                            div.bar.(HANDS[hand].1) { i style=(format!("width:{:.1}%", 100.0 * share)) {} }
                        }
                    }
                    @for share in shares { td.number { @if *share > 0.0 { (percent(*share)) } @else { "–" } } }
                }
            }
        }
    }
}
