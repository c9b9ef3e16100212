//! Planted TIFFs: uncompressed RGB whose directory stands where a test wants it.

/// Where the directory of the full image stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    Start,
    Middle,
    End,
}

/// How a TIFF is written.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    pub is_big: bool,
    pub place: Place,
    /// Width and height of its tiles; rows of its strips are the height alone.
    pub tile: Option<u32>,
}

const ROWS_PER_STRIP: u32 = 16;

/// Every way in which a directory may stand.
pub fn forms() -> Vec<Form> {
    let mut forms = Vec::new();
    for is_big in [false, true] {
        for place in [Place::Start, Place::Middle, Place::End] {
            for tile in [None, Some(64)] {
                forms.push(Form {
                    is_big,
                    place,
                    tile,
                });
            }
        }
    }
    forms
}

/// An image as a TIFF.
pub fn written(rgb: &image::RgbImage, form: Form) -> Vec<u8> {
    let (w, h) = rgb.dimensions();
    let [chunk_w, chunk_h] = form.tile.map_or([w, ROWS_PER_STRIP], |side| [side, side]);
    let mut chunks = Vec::new();
    for top in (0..h).step_by(chunk_h as usize) {
        for left in (0..w).step_by(chunk_w as usize) {
            let rows = if form.tile.is_some() {
                chunk_h
            } else {
                chunk_h.min(h - top)
            };
            let mut chunk = Vec::new();
            for y in top..top + rows {
                for x in left..left + chunk_w {
                    let inside = x < w && y < h;
                    chunk.extend(if inside {
                        rgb.get_pixel(x, y).0
                    } else {
                        [255, 0, 255]
                    });
                }
            }
            chunks.push(chunk);
        }
    }
    let count = chunks.len() as u64;
    let size: u64 = if form.is_big { 8 } else { 4 };
    let header = if form.is_big { 16 } else { 8 };
    let entries = if form.tile.is_some() { 10 } else { 9 };
    let fixed = match form.is_big {
        true => 8 + entries * 20 + 8,
        false => 2 + entries * 12 + 4,
    };
    let directory_length = fixed + 8 + 2 * size * count;
    let before = match form.place {
        Place::Start => 0,
        Place::Middle => chunks.len() / 2,
        Place::End => chunks.len(),
    };
    let length = |chunks: &[Vec<u8>]| chunks.iter().map(|c| c.len() as u64).sum::<u64>();
    let directory_at = header + length(&chunks[..before]);
    let mut at = header;
    let offsets: Vec<u64> = (chunks.iter().enumerate())
        .map(|(i, chunk)| {
            at += if i == before { directory_length } else { 0 };
            let place = at;
            at += chunk.len() as u64;
            place
        })
        .collect();
    let number = |value: u64| value.to_le_bytes()[..size as usize].to_vec();
    let (bits_at, offsets_at) = (directory_at + fixed, directory_at + fixed + 8);
    let counts_at = offsets_at + size * count;
    let mut directory = match form.is_big {
        true => entries.to_le_bytes().to_vec(),
        false => (entries as u16).to_le_bytes().to_vec(),
    };
    let long = if form.is_big { 16 } else { 4 };
    // Three numbers of 16 bits fit into the entry of a BigTIFF.
    let bits = if form.is_big {
        0x0008_0008_0008
    } else {
        bits_at
    };
    let (places, lengths) = match form.tile {
        Some(_) => (324, 325),
        None => (273, 279),
    };
    let sides = match form.tile {
        Some(side) => vec![(322, 3, 1, u64::from(side)), (323, 3, 1, u64::from(side))],
        None => vec![(278, 3, 1, u64::from(ROWS_PER_STRIP))],
    };
    let mut tags: Vec<(u16, u16, u64, u64)> = vec![
        (256, 3, 1, w.into()),
        (257, 3, 1, h.into()),
        (258, 3, 3, bits),
        (259, 3, 1, 1),
        (262, 3, 1, 2),
        (277, 3, 1, 3),
        (places, long, count, offsets_at),
        (lengths, long, count, counts_at),
    ];
    tags.extend(sides);
    tags.sort_unstable();
    assert!(tags.len() as u64 == entries && count > 2);
    for (tag, kind, count, value) in tags {
        directory.extend(tag.to_le_bytes());
        directory.extend(kind.to_le_bytes());
        directory.extend(number(count));
        directory.extend(number(value));
    }
    directory.extend(number(0));
    directory.extend([8, 0, 8, 0, 8, 0, 0, 0]);
    offsets
        .iter()
        .for_each(|&offset| directory.extend(number(offset)));
    chunks
        .iter()
        .for_each(|chunk| directory.extend(number(chunk.len() as u64)));
    assert_eq!(directory.len() as u64, directory_length);
    let mut out = match form.is_big {
        true => b"II+\0\x08\0\0\0".to_vec(),
        false => b"II*\0".to_vec(),
    };
    out.extend(number(directory_at));
    for (i, chunk) in chunks.iter().enumerate() {
        if i == before {
            out.extend(&directory);
        }
        out.extend(chunk);
    }
    if before == chunks.len() {
        out.extend(&directory);
    }
    out
}

/// Where the offset of the first directory stands.
pub fn offset_of(bytes: &[u8]) -> std::ops::Range<usize> {
    if bytes[2] == 43 { 8..16 } else { 4..8 }
}

/// Where the first directory stands.
#[allow(dead_code)]
pub fn directory_of(bytes: &[u8]) -> usize {
    let offset = &bytes[offset_of(bytes)];
    offset
        .iter()
        .rev()
        .fold(0, |sum, b| sum << 8 | usize::from(*b))
}
