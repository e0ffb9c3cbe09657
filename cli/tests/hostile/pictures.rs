//! Pictures among the assets.

use crate::bytes::{chunk, header, png, zlib};
use crate::case::{Case, Content};
use crate::runs::QUICK;

/// Draws the scene with this picture as its rug.
fn case(name: &str, picture: impl Into<Content>) -> Case {
    let call = "render --config c.yml --assets assets --camera closeup --size 8 --out a.png";
    let crib = QUICK.replace("scene: base", "scene: crib");
    Case::new(format!("picture: {name}"), call)
        .file("c.yml", crib)
        .with_assets()
        .file("assets/tex/rug.png", picture)
}

/// A picture of 2 x 2 pixels of a colour type, with other chunks before its pixels.
fn small(depth: u8, colour: u8, before: &[u8], row: &[u8]) -> Vec<u8> {
    let rows = [row, row].concat();
    png(&[&header(2, 2, depth, colour), before, &chunk(b"IDAT", &zlib(&rows))])
}

pub fn cases() -> Vec<Case> {
    let sound = small(8, 2, b"", &[0; 7]);
    let pixels = chunk(b"IDAT", &zlib(&[0; 14]));
    let damaged = |at: usize| {
        let mut bytes = sound.clone();
        bytes[at] ^= 1;
        bytes
    };
    let of_size = |width, height| png(&[&header(width, height, 8, 2), &pixels]);
    vec![
        case("empty", ""),
        case("text", "not a picture"),
        case("JPEG", b"\xff\xd8\xff\xe0\0\x10JFIF\0"),
        case("only the signature", b"\x89PNG\r\n\x1a\n"),
        case("line breaks converted", b"\x89PNG\n\x1a\n\0\0\0\rIHDR"),
        case("palette of 4 bytes", small(8, 3, &chunk(b"PLTE", &[0; 4]), &[0; 3])),
        case("palette of no bytes", small(8, 3, &chunk(b"PLTE", &[]), &[0; 3])),
        case(
            "palette of 257 colours",
            small(8, 3, &chunk(b"PLTE", &[0; 771]), &[0; 3]),
        ),
        case(
            "two palettes",
            small(
                8,
                3,
                &[chunk(b"PLTE", &[0; 6]), chunk(b"PLTE", &[0; 6])].concat(),
                &[0; 3],
            ),
        ),
        case("no palette", small(8, 3, b"", &[0; 3])),
        case(
            "index beyond the palette",
            small(8, 3, &chunk(b"PLTE", &[9; 6]), &[0, 7, 7]),
        ),
        case(
            "transparency without a palette",
            small(8, 3, &chunk(b"tRNS", &[0; 300]), &[0; 3]),
        ),
        case("wrong checksum of the header", damaged(30)),
        case("wrong checksum of the pixels", damaged(sound.len() - 14)),
        case("wrong checksum inside the pixels", damaged(45)),
        case("cut in the header", &sound[..20]),
        case("cut in the pixels", &sound[..50]),
        case("cut before its end", &sound[..sound.len() - 12]),
        case("no pixels", png(&[&header(2, 2, 8, 2)])),
        case("pixels before the header", png(&[&pixels, &header(2, 2, 8, 2)])),
        case("two headers", png(&[&header(2, 2, 8, 2), &header(2, 2, 8, 2), &pixels])),
        case(
            "too few pixels",
            png(&[&header(2, 2, 8, 2), &chunk(b"IDAT", &zlib(&[0; 5]))]),
        ),
        case(
            "pixels that are not compressed",
            png(&[&header(2, 2, 8, 2), &chunk(b"IDAT", &[7; 20])]),
        ),
        case("unknown filter", small(8, 2, b"", &[9; 7])),
        case("no width", of_size(0, 2)),
        case("no height", of_size(2, 0)),
        case("8193 pixels wide", of_size(8193, 1)),
        case("4 billion pixels wide", of_size(u32::MAX, u32::MAX)),
        case("8192 x 8192 that are not there", of_size(8192, 8192)),
        case("colour type 5", small(8, 5, b"", &[0; 7])),
        case("3 bits", small(3, 0, b"", &[0; 3])),
        case(
            "16 bits with a palette",
            small(16, 3, &chunk(b"PLTE", &[0; 6]), &[0; 5]),
        ),
        case("unknown chunk that matters", small(8, 2, &chunk(b"XYZW", b""), &[0; 7])),
        case("chunk without a name", small(8, 2, &chunk(b"\0\0\0\0", b""), &[0; 7])),
        case(
            "chunk longer than the file",
            [&sound[..33], b"\x7f\xff\xff\xffIDAT"].concat(),
        ),
        case(
            "100,000 chunks of text and no end",
            [&sound[..33], &chunk(b"tEXt", b"").repeat(100_000)[..]].concat(),
        ),
        case("a link that leaves the folder", Content::Link("/etc/passwd")),
        case("a pipe", Content::Pipe),
        case("a folder", Content::Folder),
        case("65 MiB of zeros", Content::Zeros(65 << 20)),
    ]
}
