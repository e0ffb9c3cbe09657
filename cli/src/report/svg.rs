//! Charts as separate files.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

/// The page's style of charts, on white paper. Font names are those that programs for drawing such files know.
const STYLE: &str = "svg{font:12px Helvetica,Arial,sans-serif;color:#1d2430}\
    .grid{stroke:#e2e3e6;fill:none}.tick{fill:#5c6675}.goal{stroke:#5a9367;stroke-dasharray:5 4}\
    .dot,.key.dots{fill:#5c6675;fill-opacity:.4}.line{fill:none;stroke-width:2.5;stroke-linejoin:round;stroke:#1d2430}\
    .line.base{stroke:#5c6675;stroke-dasharray:6 4}.line.right{stroke:#e4572e}.line.left{stroke:#2e86de}\
    g.right,.key.right{fill:#e4572e}g.left,.key.left{fill:#2e86de}.key.base{fill:#5c6675}\
    .view{fill:none;stroke:#5c6675}.scored{fill:none;stroke:#1d2430;stroke-width:1.5;stroke-dasharray:4 3}";
/// Height of a line of the legend.
const LINE: f64 = 18.0;

/// Returns a link that saves a chart, an `svg` element of a width and height, as a file with its style and its legend: pairs of a
/// class and a text. The page stays without scripts.
pub(super) fn download(chart: &Markup, [width, height]: [f64; 2], legend: &[(&str, &str)], name: &str) -> Markup {
    let total = height
        + if legend.is_empty() {
            0.0
        } else {
            LINE * legend.len() as f64 + 6.0
        };
    let mut file = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {total}\" width=\"{width}\" height=\"{total}\">\
         <style>{STYLE}</style><rect width=\"{width}\" height=\"{total}\" fill=\"#fff\"/>"
    );
    let inner = format!("<svg width=\"{width}\" height=\"{height}\" ");
    file.push_str(&chart.0.replacen("<svg ", &inner, 1));
    for (k, (class, text)) in legend.iter().enumerate() {
        let y = height + LINE * (k as f64 + 0.7);
        let line = html! {
            rect.key.(class) x="44" y=(format!("{:.1}", y - 9.0)) width="10" height="10" rx="2" {}
            text.tick x="60" y=(format!("{y:.1}")) { (text) }
        };
        file.push_str(&line.0);
    }
    file.push_str("</svg>\n");
    html! { a.save href=(embed("svg+xml", file.as_bytes())) download=(format!("{name}.svg")) { "save as SVG" } }
}

/// Returns a file as a `data:` address.
pub(super) fn embed(kind: &str, bytes: &[u8]) -> String {
    let mut out = format!("data:image/{kind};base64,");
    STANDARD.encode_string(bytes, &mut out);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_becomes_a_file_with_its_legend() {
        let chart = html! { svg viewBox="0 0 10 5" { text { "a < b" } } };
        let link = download(&chart, [10.0, 5.0], &[("right", "right & wrong")], "curve").into_string();
        let (_, data) = link.split_once("base64,").expect("an address");
        let (data, rest) = data.split_once('"').expect("its end");
        assert!(rest.contains("download=\"curve.svg\""), "{rest}");
        use base64::Engine as _;
        let file = base64::engine::general_purpose::STANDARD.decode(data).expect("base64");
        let file = String::from_utf8(file).expect("text");
        assert!(
            file.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 10 29\""),
            "{file}"
        );
        assert!(
            file.contains("<svg width=\"10\" height=\"5\" viewBox=\"0 0 10 5\">"),
            "{file}"
        );
        assert!(
            file.contains("right &amp; wrong") && file.contains("a &lt; b"),
            "{file}"
        );
    }
}
