//! The fuzz targets, run on mutated seeds: `FUZZ_INPUTS=1000000 cargo test --test cpu fuzzed` runs that many for each target, and
//! `FUZZ_SEED=2` others. An input that fails is written to a file.

#[path = "../../fuzz/src/targets.rs"]
mod targets;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

const INPUTS: u64 = 1500;

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }

    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        start..start + self.below((length - start).min(64) + 1)
    }
}

const NUMBERS: [&str; 16] = [
    "0",
    "1",
    "-1",
    "2",
    "3",
    "4",
    "7",
    "255",
    "256",
    "65536",
    "2147483648",
    "4294967295",
    "18446744073709551615",
    "1e308",
    "nan",
    "0.5",
];

/// One change, or several.
fn mutated(random: &mut Random, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..1 << random.below(5) {
        let range = random.range(bytes.len());
        match random.below(9) {
            0 if !bytes.is_empty() => {
                let place = random.below(bytes.len());
                bytes[place] ^= 1 << random.below(8);
            }
            1 if !bytes.is_empty() => {
                let place = random.below(bytes.len());
                bytes[place] = random.next() as u8;
            }
            2 => drop(bytes.drain(range)),
            3 => {
                let part = bytes[range].to_vec();
                let place = random.below(bytes.len() + 1);
                bytes.splice(place..place, part);
            }
            4 => bytes.truncate(bytes.len() - random.below(bytes.len() / 4 + 1)),
            5 => {
                let other = &seeds[random.below(seeds.len())];
                let part = other[random.range(other.len())].to_vec();
                bytes.splice(range, part);
            }
            // A number of the text, or four bytes, replaced.
            6 | 7 => {
                let is_number = |byte: &u8| byte.is_ascii_digit() || *byte == b'-';
                let start = range.start + bytes[range.start..].iter().position(is_number).unwrap_or(0);
                let end = start + bytes[start..].iter().take_while(|byte| is_number(byte)).count();
                bytes.splice(start..end, NUMBERS[random.below(NUMBERS.len())].bytes());
            }
            _ => {
                let value = [0u32, 1, 0xff, 0xffff, 0x7fff_ffff, 0x8000_0000, u32::MAX, u32::MAX - 1][random.below(8)];
                let end = (range.start + 4).min(bytes.len());
                bytes.splice(range.start..end, value.to_le_bytes());
            }
        }
    }
    bytes
}

/// Runs a target; those inputs that it gets furthest with are not known, so seeds stay as they are.
fn fuzz(name: &str, seeds: &[Vec<u8>], target: fn(&[u8])) {
    seeds.iter().for_each(|seed| target(seed));
    let (inputs, mut random) = (setting("FUZZ_INPUTS", INPUTS), Random(setting("FUZZ_SEED", 1)));
    let (start, mut slowest) = (Instant::now(), Duration::ZERO);
    for _ in 0..inputs {
        let bytes = mutated(&mut random, seeds);
        let before = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| target(&bytes)));
        slowest = slowest.max(before.elapsed());
        if outcome.is_err() {
            let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzzed-{name}"));
            std::fs::write(&path, &bytes).unwrap();
            panic!("{} bytes, written to {}: {:?}", bytes.len(), path.display(), String::from_utf8_lossy(&bytes));
        }
    }
    println!("{name}: {inputs} inputs in {:.1?}, the slowest {slowest:.1?}", start.elapsed());
}

/// A can of ten sides: quads and two polygons, with tags.
const OBJ: &str = "o can\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\n\
    vt 1 1\nvn 0 0 1\nf 4/1/1 3/2/1 2/3/1 1/1/1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf -10 -3 -6 -7\nf 2//1 9//1 10//1 3//1\n\
    t crease 3/2/0 0 1 2 2.5 10\nt corner 1/1/0 3 4\nt hole 1/0/0 2\nt interpolateboundary 1/0/0 2\nt creasemethod 0/0/1 chaikin\n\
    t faceedit 3/0/1 2 0 1 hole\nt vertexedit 4/3/3 3 1 0 2 0 0 0.5 add P value\nt edgeedit 3/1/3 2 3 1 2 set P sharpness\n";

/// A Moebius band, a fin, faces on one another, and two tetrahedra that touch.
const ODD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nf 1 2 5 4\nf 2 3 6 5\nf 3 4 1 6\nf 1 2 3\nf 1 2 3 4\nf 2 1 6\nf 3 3 1\nf 1 2 1 3\n\
    f 1 2 5 6 2 3\nt crease 2/1/0 0 1 3\nt corner 2/1/0 0 5 3\n";

const PLY: &str = "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    property float s\nproperty float t\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
    0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n3 0 1 2\n3 0 2 3\n";

#[test]
fn obj() {
    let utf_16 = |text: &str| [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    fuzz("obj", &[OBJ.into(), ODD.into(), [OBJ, ODD].concat().into(), utf_16(ODD)], targets::obj);
}

#[test]
fn ply() {
    let mut binary =
        PLY.split_inclusive("end_header\n").next().unwrap().replace("ascii", "binary_little_endian").into_bytes();
    for corner in [[0f32, 0., 0., 0., 0.], [1., 0., 0., 1., 0.], [1., 1., 0., 1., 1.], [0., 1., 0., 0., 1.]] {
        binary.extend(corner.iter().flat_map(|x| x.to_le_bytes()));
    }
    for face in [[0u32, 1, 2], [0, 2, 3]] {
        binary.push(3);
        binary.extend(face.iter().flat_map(|x| x.to_le_bytes()));
    }
    fuzz("ply", &[PLY.into(), binary], targets::ply);
}

#[test]
fn mesh() {
    let mut random = Random(7);
    let seeds: Vec<Vec<u8>> = (0..64).map(|_| (0..200).map(|_| random.next() as u8).collect()).collect();
    fuzz("mesh", &seeds, targets::mesh);
}

#[test]
fn gltf() {
    let json = super::reader_properties::gltf::animated_json();
    let text = serde_json::to_vec(&json).unwrap();
    fuzz("gltf", &[super::reader_properties::gltf::glb(&json), text], targets::gltf);
}

#[test]
fn picture() {
    use image::{DynamicImage, ImageFormat};
    use std::io::Cursor;
    let mut seeds = Vec::new();
    let grey = image::GrayImage::from_raw(3, 2, (0..6).collect()).unwrap();
    let wide: image::ImageBuffer<image::Rgba<u16>, _> = image::ImageBuffer::from_raw(2, 2, (0..16).collect()).unwrap();
    let float = image::Rgba32FImage::from_raw(2, 2, (0..16).map(|x| x as f32).collect()).unwrap();
    for (picture, format) in [
        (DynamicImage::from(grey), ImageFormat::Png),
        (DynamicImage::from(wide), ImageFormat::Png),
        (DynamicImage::from(float), ImageFormat::OpenExr),
    ] {
        let mut file = Cursor::new(Vec::new());
        picture.write_to(&mut file, format).unwrap();
        seeds.push(file.into_inner());
    }
    fuzz("picture", &seeds, targets::picture);
}
