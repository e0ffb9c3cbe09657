//! Formats, written by hand so that anything in them can be wrong.

/// CRC-32, as zip and PNG have it.
pub fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| {
            (c >> 1) ^ (0xedb8_8320 & 0u32.wrapping_sub(c & 1))
        })
    })
}

/// A chunk of a PNG picture.
pub fn chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let checked = [&name[..], data].concat();
    [
        &(data.len() as u32).to_be_bytes()[..],
        &checked,
        &crc(&checked).to_be_bytes(),
    ]
    .concat()
}

/// The header of a PNG picture.
pub fn header(width: u32, height: u32, depth: u8, colour: u8) -> Vec<u8> {
    let sizes = [width.to_be_bytes(), height.to_be_bytes()].concat();
    chunk(b"IHDR", &[&sizes[..], &[depth, colour, 0, 0, 0]].concat())
}

/// A PNG picture of chunks, with its last one.
pub fn png(chunks: &[&[u8]]) -> Vec<u8> {
    [&b"\x89PNG\r\n\x1a\n"[..], &chunks.concat(), &chunk(b"IEND", b"")].concat()
}

/// A zlib stream that is stored, not compressed: at most 65,535 bytes.
pub fn zlib(data: &[u8]) -> Vec<u8> {
    let (a, b) = data.iter().fold((1u32, 0u32), |(a, b), &byte| {
        let a = (a + u32::from(byte)) % 65521;
        (a, (b + a) % 65521)
    });
    let n = data.len() as u16;
    let sizes = [n.to_le_bytes(), (!n).to_le_bytes()].concat();
    [&[0x78, 1, 1][..], &sizes, data, &((b << 16) | a).to_be_bytes()].concat()
}

/// A NumPy array with any text as its header.
pub fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let length = (header.len() as u16 + 1).to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), b"\n", data].concat()
}

/// A NumPy array of a type and a shape.
pub fn array(dtype: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    npy(
        &format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}"),
        data,
    )
}

/// A zip archive of files that are stored.
pub fn zip(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, data) in files {
        let (length, at) = ((data.len() as u32).to_le_bytes(), (out.len() as u32).to_le_bytes());
        let about = [
            &[20, 0, 0, 0, 0, 0, 0, 0, 33, 0],
            &crc(data).to_le_bytes()[..],
            &length,
            &length,
        ]
        .concat();
        let about = [&about[..], &(name.len() as u16).to_le_bytes(), &[0, 0]].concat();
        out.extend([b"PK\x03\x04", &about[..], name.as_bytes(), data].concat());
        directory.extend([b"PK\x01\x02\x14\x00", &about[..], &[0; 10], &at, name.as_bytes()].concat());
    }
    let (n, length) = (
        (files.len() as u16).to_le_bytes(),
        (directory.len() as u32).to_le_bytes(),
    );
    let at = (out.len() as u32).to_le_bytes();
    [
        &out[..],
        &directory,
        b"PK\x05\x06\0\0\0\0",
        &n,
        &n,
        &length,
        &at,
        &[0, 0],
    ]
    .concat()
}

/// A pickle of protocol 4 with these opcodes.
pub fn pickle(opcodes: &[u8]) -> Vec<u8> {
    [b"\x80\x04", opcodes, b"."].concat()
}

/// Opcodes of a short text.
pub fn text(value: &str) -> Vec<u8> {
    [&[0x8c, value.len() as u8], value.as_bytes()].concat()
}

/// Opcodes of a dictionary.
pub fn dict(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let entries: Vec<u8> = entries
        .iter()
        .flat_map(|(key, value)| [&text(key), *value].concat())
        .collect();
    [b"}(", &entries[..], b"u"].concat()
}

/// Opcodes of a list.
pub fn list(items: &[&[u8]]) -> Vec<u8> {
    [b"](", &items.concat()[..], b"e"].concat()
}

/// A field of a protobuf message that holds bytes.
pub fn field(number: u64, data: &[u8]) -> Vec<u8> {
    [&varint(number << 3 | 2)[..], &varint(data.len() as u64), data].concat()
}

/// A field of a protobuf message that holds a number.
pub fn number(field: u64, value: u64) -> Vec<u8> {
    [varint(field << 3), varint(value)].concat()
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut out = Vec::new();
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
    out
}
