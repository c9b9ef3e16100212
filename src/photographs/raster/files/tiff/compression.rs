//! One strip or tile to bytes.

use std::borrow::Cow;
use std::io::Read;

use weezl::{BitOrder, LzwStatus};

use super::super::jpeg::{JpegPart, decode_part};

/// How strips and tiles are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Lzw,
    Deflate,
    PackBits,
    Zstd,
    Jpeg,
}

impl Compression {
    /// By the number of the tag; otherwise the name of what is not read.
    pub(super) fn new(number: u64) -> Result<Self, String> {
        let unread = match number {
            1 => return Ok(Self::None),
            5 => return Ok(Self::Lzw),
            7 => return Ok(Self::Jpeg),
            8 | 32946 => return Ok(Self::Deflate),
            32773 => return Ok(Self::PackBits),
            50000 => return Ok(Self::Zstd),
            2..=4 => "CCITT (fax)",
            6 => "JPEG of the old style (of 1992)",
            33003 | 33005 | 34712 => "JPEG 2000",
            34887 => "LERC",
            34925 => "LZMA",
            50001 => "WebP",
            50002 | 52546 => "JPEG XL",
            other => return Err(format!("number {other}")),
        };
        Err(unread.to_owned())
    }

    /// Does a predictor go with it? Others ignore the tag, as libtiff does.
    pub(super) fn has_predictor(self) -> bool {
        matches!(self, Self::Lzw | Self::Deflate | Self::Zstd)
    }
}

/// The `expected` bytes of a strip or tile.
pub(super) fn decompress(
    compression: Compression,
    data: &[u8],
    expected: usize,
) -> Result<Cow<'_, [u8]>, String> {
    let found = match compression {
        Compression::None => Cow::Borrowed(data.get(..expected).unwrap_or(data)),
        Compression::Lzw => Cow::Owned(lzw(data, expected)?),
        Compression::PackBits => Cow::Owned(pack_bits(data, expected)),
        Compression::Deflate => Cow::Owned(read(flate2::read::ZlibDecoder::new(data), expected)?),
        Compression::Zstd => {
            let stream = ruzstd::decoding::StreamingDecoder::new(data);
            Cow::Owned(read(stream.map_err(|e| e.to_string())?, expected)?)
        }
        Compression::Jpeg => return Err("JPEG has a size of its own".to_owned()),
    };
    match found.len() == expected {
        true => Ok(found),
        false => Err(format!("{} bytes instead of {expected}", found.len())),
    }
}

/// The bytes of a strip or tile that is a JPEG, whose tables may stand in the directory.
pub(super) fn decompress_jpeg(
    tables: Option<&[u8]>,
    data: &[u8],
    wanted: &JpegPart,
) -> Result<Vec<u8>, String> {
    const START: &[u8] = &[0xff, 0xd8];
    const END: &[u8] = &[0xff, 0xd9];
    let joined = match tables {
        Some(tables) => {
            let tables = tables.strip_suffix(END).unwrap_or(tables);
            [tables, data.strip_prefix(START).unwrap_or(data)].concat()
        }
        None => data.to_vec(),
    };
    decode_part(joined, wanted)
}

/// Memory is taken as the data come, so that no claim in a damaged file takes it.
fn read(stream: impl Read, expected: usize) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    match stream.take(expected as u64).read_to_end(&mut out) {
        // What follows the last sample does not matter.
        Err(error) if out.len() < expected => Err(error.to_string()),
        _ => Ok(out),
    }
}

fn lzw(data: &[u8], expected: usize) -> Result<Vec<u8>, String> {
    // Memory is taken by so much at a time, as in [`read`].
    const BLOCK_BYTES: usize = 1 << 16;
    if data.first() == Some(&0) && data.get(1).is_some_and(|b| b & 1 == 1) {
        return Err("LZW of the old style (before TIFF 6.0)".to_owned());
    }
    let mut decoder = weezl::decode::Decoder::with_tiff_size_switch(BitOrder::Msb, 8);
    let (mut rest, mut out) = (data, Vec::new());
    while out.len() < expected {
        let start = out.len();
        out.resize(expected.min(start + BLOCK_BYTES), 0);
        let step = decoder.decode_bytes(rest, &mut out[start..]);
        rest = rest.get(step.consumed_in..).unwrap_or_default();
        out.truncate(start + step.consumed_out);
        match step.status.map_err(|e| e.to_string())? {
            LzwStatus::Ok => {}
            LzwStatus::NoProgress | LzwStatus::Done => break,
        }
    }
    Ok(out)
}

/// Runs and copies (TIFF 6.0, section 9).
fn pack_bits(mut data: &[u8], expected: usize) -> Vec<u8> {
    let mut out = Vec::new();
    while let ([head, rest @ ..], true) = (data, out.len() < expected) {
        let count = usize::from(*head);
        data = match *head {
            0..128 => {
                let (copied, rest) = rest.split_at(rest.len().min(count + 1));
                out.extend_from_slice(copied);
                rest
            }
            128 => rest,
            129.. => match rest {
                [value, rest @ ..] => {
                    out.resize(out.len() + 257 - count, *value);
                    rest
                }
                [] => rest,
            },
        };
    }
    out.truncate(expected);
    out
}
