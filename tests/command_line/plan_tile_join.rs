//! A large area on many machines: `plan`, `tile` and `join` give what one process gives, whatever
//! is killed on the way, and refuse by name what does not belong together.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

/// Four tiles of four squares, from west to east: the house stands where the squares of the first
/// one meet, the others see nothing of it.
const AREA: [&str; 4] = ["--roi", "-31,-31,310,31", "--ground-z", "0"];
const TILES: u32 = 4;

fn ridgeline() -> Command {
    Command::new(env!("CARGO_BIN_EXE_ridgeline"))
}

fn words(output: &Output) -> String {
    let both = [&output.stdout[..], &output.stderr[..]].concat();
    String::from_utf8_lossy(&both).into_owned()
}

/// A folder with a scene, and a plan of it.
struct Block(tempfile::TempDir);

impl Block {
    /// Does an archive of the files give the results that the folder does?
    fn is_the_same_from(&self, archive: &[u8]) {
        fs::write(self.0.path().join("scene.zip"), archive).unwrap();
        let model_of = |scene: &str, out: &str| {
            let mut command = self.command();
            command.args(["reconstruct", scene, "--roi", "-31,-31,31,31", "--out", out]);
            let output = command.args(["--max-views", "3"]).output().unwrap();
            assert!(output.status.success(), "{}", words(&output));
            let mut files = files_in(&self.0.path().join(out));
            files.remove("report.json");
            files
        };
        assert!(model_of("scene", "a") == model_of("scene.zip", "b"));
    }

    /// Without a plan.
    fn of(files: Vec<(String, Vec<u8>)>) -> Self {
        let block = Self(tempfile::tempdir().unwrap());
        for (path, bytes) in files {
            let path = block.scene().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
        block
    }

    /// A plan without parts.
    fn planned() -> Self {
        let block = Self::of(crate::common::synthetic_files());
        let output = block.plan("120", &block.folder());
        assert!(output.status.success(), "{}", words(&output));
        block
    }

    /// The reference's plan, which is that of the same scene.
    fn with_plan() -> Self {
        let block = Self::of(crate::common::synthetic_files());
        fs::create_dir(block.folder()).unwrap();
        fs::write(block.folder().join("tiles.json"), &reference().plan).unwrap();
        block
    }

    /// The reference's plan with its parts, and a scene of its own.
    fn done() -> Self {
        let block = Self::with_plan();
        fs::create_dir(block.folder().join("parts")).unwrap();
        for tile in 1..=TILES {
            fs::write(block.part(tile), &reference().parts[tile as usize - 1]).unwrap();
        }
        block
    }

    fn scene(&self) -> PathBuf {
        self.0.path().join("scene")
    }

    fn folder(&self) -> PathBuf {
        self.0.path().join("plan")
    }

    fn out(&self) -> PathBuf {
        self.0.path().join("out")
    }

    fn part(&self, tile: u32) -> PathBuf {
        self.folder().join(format!("parts/{tile}.part"))
    }

    /// Commands run in the block's folder: plans of the same scene are the same then.
    fn command(&self) -> Command {
        let mut command = ridgeline();
        command.current_dir(self.0.path());
        command
    }

    fn plan(&self, tile_m: &str, to: &Path) -> Output {
        let mut command = self.command();
        command.args(["plan", "scene", "--tile", tile_m]);
        command.args(AREA).arg("--out").arg(to).output().unwrap()
    }

    fn tile_command(&self, tile: u32) -> Command {
        let mut command = self.command();
        command.args(["tile", "plan", &tile.to_string()]);
        command
    }

    fn tile(&self, tile: u32) -> Output {
        self.tile_command(tile).output().unwrap()
    }

    fn join_command(&self) -> Command {
        let mut command = self.command();
        command.args(["join", "plan", "--out", "out"]);
        command
    }

    fn join(&self) -> Output {
        self.join_command().output().unwrap()
    }

    /// Expects a refusal that names all of `words`, and no results.
    fn is_refused(&self, output: &Output, named: &[&str]) {
        let message = words(output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for word in named {
            assert!(message.contains(word), "'{word}' is not in: {message}");
        }
        assert!(!self.out().exists(), "{message}");
    }
}

/// What undisturbed processes make.
struct Reference {
    plan: Vec<u8>,
    parts: Vec<Vec<u8>>,
    model: BTreeMap<String, Vec<u8>>,
    /// How long a tile with a house and the joining take.
    times: [Duration; 2],
}

fn reference() -> &'static Reference {
    static REFERENCE: OnceLock<Reference> = OnceLock::new();
    REFERENCE.get_or_init(|| {
        let block = Block::planned();
        let mut times = Vec::new();
        let parts = (1..=TILES).map(|tile| {
            let start = Instant::now();
            let output = block.tile(tile);
            times.push(start.elapsed());
            assert!(output.status.success(), "{}", words(&output));
            fs::read(block.part(tile)).unwrap()
        });
        let parts = parts.collect();
        let start = Instant::now();
        let output = block.join();
        assert!(output.status.success(), "{}", words(&output));
        Reference {
            plan: fs::read(block.folder().join("tiles.json")).unwrap(),
            parts,
            model: files_in(&block.out()),
            times: [times[0], start.elapsed()],
        }
    })
}

fn files_in(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let file = |entry: fs::DirEntry| {
        let name = entry.file_name().into_string().unwrap();
        (name, fs::read(entry.path()).unwrap())
    };
    entries.map(|entry| file(entry.unwrap())).collect()
}

/// A report without the times, which no two runs share.
fn report(bytes: &[u8]) -> Value {
    let mut report: Value = serde_json::from_slice(bytes).unwrap();
    report["seconds"] = Value::Null;
    report
}

#[test]
fn parts_of_many_processes_are_the_model_of_one() {
    let block = Block::of(crate::common::synthetic_files());
    let whole_of = |tile_m: &str| {
        let mut command = block.command();
        command.args(["reconstruct", "scene", "--tile", tile_m, "--out", tile_m]);
        let output = command.args(AREA).output().unwrap();
        assert!(output.status.success(), "{}", words(&output));
        files_in(&block.0.path().join(tile_m))
    };
    let mut whole = whole_of("120");
    let mut joined = reference().model.clone();
    let [one, other] = [&mut whole, &mut joined].map(|f| report(&f.remove("report.json").unwrap()));
    assert_eq!(one, other);
    assert!(one["buildings"] == 1 && one["tiles"].as_array().unwrap().len() == 4);
    assert!(whole.keys().eq(joined.keys()), "{:?}", joined.keys());
    for (name, bytes) in &whole {
        assert!(bytes == &joined[name], "{name} differs");
    }
    // The model does not depend on the tiles.
    let mut other = whole_of("60");
    let report = report(&other.remove("report.json").unwrap());
    assert!(report["tiles"].as_array().unwrap().len() > 4);
    assert!(whole == other, "{:?}", other.keys());
}

#[test]
fn a_plan_says_what_each_tile_reads() {
    let plan: Value = serde_json::from_slice(&reference().plan).unwrap();
    let tiles = plan["tiles"].as_array().unwrap();
    assert_eq!(tiles.len(), TILES as usize);
    let house = &tiles[0]["cells"][0];
    let west = |of: &str| house["place"][of][0].as_f64().unwrap();
    assert!((-31.0..-5.0).contains(&west("core")) && west("region") < west("core"));
    let sites = plan["sites"].as_array().unwrap();
    assert!(sites.iter().any(|site| site["is_worked_on"] == true));
    let views = house["views"].as_array().unwrap();
    assert!(views.len() >= 3 && house["memory_mb"].as_u64().unwrap() > 20);
    let (width, name) = (&views[0]["window"][2], &views[0]["view"]);
    assert!((64..=u64::from(crate::common::SIZE_PX)).contains(&width.as_u64().unwrap()));
    let inputs = plan["inputs"].as_array().unwrap();
    let path = format!("images/{}", name.as_str().unwrap());
    assert!(inputs.iter().any(|input| input["file"] == path), "{path}");
    // The views do not show the last tile: it says so, and its part is there nevertheless.
    let last = tiles[3]["cells"].as_array().unwrap();
    let mut why = last.iter().map(|cell| cell["left_out"].as_str().unwrap());
    assert!(why.all(|why| why.contains("is seen by")));
    assert!(reference().parts[3].len() < 1000);
}

#[test]
fn without_a_region_the_area_is_what_three_views_show() {
    let block = Block::of(crate::common::synthetic_files());
    let mut command = block.command();
    command.args(["plan", "scene", "--tile", "60", "--out", "all"]);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", words(&output));
    let text = fs::read(block.0.path().join("all/tiles.json")).unwrap();
    let plan: Value = serde_json::from_slice(&text).unwrap();
    let roi = [0, 1, 2, 3].map(|i| plan["options"]["roi"][i].as_f64().unwrap());
    assert!(roi[0] < -5.0 && roi[1] < -5.0 && roi[2] > 5.0 && roi[3] > 5.0);
    assert!(roi.iter().all(|v| v.abs() < 200.0), "{roi:?}");
}

#[test]
fn the_same_inputs_give_the_same_bytes() {
    let block = Block::planned();
    let path = block.folder().join("tiles.json");
    assert!(fs::read(&path).unwrap() == reference().plan);
    // Planned again, the file is not touched: an engine goes by its time.
    let time = || fs::metadata(&path).unwrap().modified().unwrap();
    let before = time();
    sleep(Duration::from_millis(20));
    assert!(block.plan("120", &block.folder()).status.success());
    assert_eq!(time(), before);
    let mut command = block.tile_command(1);
    assert!(command.args(["--threads", "1"]).status().unwrap().success());
    assert!(fs::read(block.part(1)).unwrap() == reference().parts[0]);
    // A whole part is kept.
    let again = words(&block.tile(1));
    assert!(again.contains("made before"), "{again}");
}

#[test]
fn every_line_of_the_sequence_is_a_valid_feature() {
    let text = std::str::from_utf8(&reference().model["model.city.jsonl"]).unwrap();
    let mut lines = text.lines();
    let first = lines.next().unwrap();
    let mut validator = cjval::CJValidator::from_str(first);
    let is_sound = |validator: &cjval::CJValidator, line: &str| {
        for (criterion, summary) in validator.validate() {
            assert!(!summary.has_errors(), "{criterion}: {summary} in {line}");
        }
    };
    is_sound(&validator, first);
    let model = &reference().model;
    let [of_lines, of_whole] = ["model.city.jsonl", "model.city.json"].map(|name| {
        ridgeline::results::export::ReportedModel::read(&model[name])
            .unwrap()
            .files(&[])
    });
    assert!(of_lines == of_whole, "the reports differ");
    let whole: Value = serde_json::from_slice(&reference().model["model.city.json"]).unwrap();
    let head: Value = serde_json::from_str(first).unwrap();
    assert_eq!(head["transform"], whole["transform"]);
    assert_eq!(head["metadata"], whole["metadata"]);
    let mut ids = Vec::new();
    for line in lines {
        validator.from_str_cjfeature(line).unwrap();
        is_sound(&validator, line);
        let feature: Value = serde_json::from_str(line).unwrap();
        let id = feature["id"].as_str().unwrap().to_owned();
        // With one building its corners are those of the whole file.
        assert_eq!(feature["CityObjects"], whole["CityObjects"]);
        assert_eq!(feature["vertices"], whole["vertices"]);
        assert_eq!(feature["appearance"], whole["appearance"]);
        ids.push(id);
    }
    assert_eq!(ids, ["building-1"]);
}

#[test]
fn missing_truncated_and_foreign_parts_are_refused_by_name() {
    let block = Block::done();
    let [one, three] = [&reference().parts[0], &reference().parts[2]];
    fs::remove_file(block.part(2)).unwrap();
    let advice = "ridgeline tile PLAN 2";
    block.is_refused(
        &block.join(),
        &["parts/2.part: the part is missing", advice],
    );
    fs::write(block.part(2), &one[..one.len() / 2]).unwrap();
    block.is_refused(
        &block.join(),
        &["parts/2.part: the part is that of tile 1", advice],
    );
    let two = &reference().parts[1];
    for length in [0, 20, two.len() / 2, two.len() - 1] {
        fs::write(block.part(2), &two[..length]).unwrap();
        block.is_refused(
            &block.join(),
            &["parts/2.part: the part is truncated", advice],
        );
    }
    let mut damaged = two.clone();
    damaged[two.len() / 2] ^= 1;
    fs::write(block.part(2), &damaged).unwrap();
    block.is_refused(
        &block.join(),
        &["parts/2.part: the part is damaged", advice],
    );
    fs::write(block.part(2), two).unwrap();
    // The third tile is empty in another plan, too.
    let other = Block::of(crate::common::synthetic_files());
    assert!(other.plan("121", &other.folder()).status.success());
    assert!(other.tile(3).status.success());
    let foreign = fs::read(other.part(3)).unwrap();
    assert!(foreign.len() == three.len() && foreign != *three);
    fs::write(block.part(3), foreign).unwrap();
    let named = ["parts/3.part: the part is foreign", "ridgeline tile PLAN 3"];
    block.is_refused(&block.join(), &named);
    // What is advised mends it.
    assert!(block.tile(3).status.success());
    assert!(block.join().status.success());
    assert!(files_in(&block.out()) == reference().model);
}

#[test]
fn what_changed_since_the_plan_is_refused_by_name() {
    let block = Block::done();
    fs::remove_file(block.part(3)).unwrap();
    // Results among the photographs change nothing.
    fs::write(block.scene().join("model_atlas.jpg"), b"more").unwrap();
    assert!(block.tile(3).status.success());
    fs::remove_file(block.part(3)).unwrap();
    // A list of the orientation, and the first bytes of a photograph, which every step reads.
    let image = block.scene().join("images/s2_03.png");
    for (path, place) in [
        (&image, 0.1),
        (&block.scene().join("colmap/images.txt"), 0.9),
    ] {
        let sound = fs::read(path).unwrap();
        fs::write(path, changed_at(&sound, place)).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap();
        let named = [name, ": the file has changed since the plan was made"];
        block.is_refused(&block.tile(3), &named);
        assert!(!block.part(3).exists());
        // One byte more, at its end.
        fs::write(path, [&sound[..], b" "].concat()).unwrap();
        block.is_refused(&block.tile(3), &named);
        fs::write(path, sound).unwrap();
    }
    let sound = fs::read(&image).unwrap();
    fs::remove_file(&image).unwrap();
    block.is_refused(&block.tile(3), &["images/s2_03.png: the file is missing"]);
    fs::write(&image, sound).unwrap();
    block.is_refused(&block.tile(9), &["the plan has no tile 9", "1 to 4"]);
    let path = block.folder().join("tiles.json");
    let text = String::from_utf8(reference().plan.clone()).unwrap();
    let version = format!("\"ridgeline\": \"{}\"", env!("CARGO_PKG_VERSION"));
    fs::write(&path, text.replace(&version, "\"ridgeline\": \"0.0.1\"")).unwrap();
    block.is_refused(&block.tile(3), &["the plan is of ridgeline 0.0.1"]);
    // Other parameters make another plan, to which the parts do not belong.
    assert!(text.contains("\"jpeg_quality\": "));
    fs::write(
        &path,
        text.replace("\"jpeg_quality\": ", "\"jpeg_quality\": 1"),
    )
    .unwrap();
    let refused = block.join();
    assert_eq!(refused.status.code(), Some(2), "{}", words(&refused));
    fs::remove_file(&path).unwrap();
    block.is_refused(
        &block.join(),
        &["tiles.json: cannot be read", "ridgeline plan"],
    );
}

/// Another byte at a share of the whole.
fn changed_at(bytes: &[u8], place: f64) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let at = (place * (bytes.len() - 1) as f64) as usize;
    bytes[at] ^= 1;
    bytes
}

/// A plan whose cells have three views each, and the first tile that has one.
struct FewViews<'a> {
    block: &'a Block,
    plan: Value,
    tile: usize,
}

impl<'a> FewViews<'a> {
    fn of(block: &'a Block) -> Self {
        let mut command = block.command();
        command.args(["plan", "scene", "--tile", "60", "--max-views", "3"]);
        let planned = command.args(AREA).args(["--out", "few"]).output().unwrap();
        assert!(planned.status.success(), "{}", words(&planned));
        let text = fs::read(block.0.path().join("few/tiles.json")).unwrap();
        let plan: Value = serde_json::from_slice(&text).unwrap();
        let mut tiles = plan["tiles"].as_array().unwrap().iter();
        let tile = tiles
            .position(|tile| tile["cells"].get(0).is_some())
            .unwrap();
        Self { block, plan, tile }
    }

    /// The views of its first cell.
    fn views(&self) -> &Vec<Value> {
        let cell = &self.plan["tiles"][self.tile]["cells"][0];
        cell["views"].as_array().unwrap()
    }

    fn reads(&self, name: &str) -> bool {
        self.views().iter().any(|view| view["view"] == name)
    }

    fn path(&self) -> PathBuf {
        let name = format!("few/parts/{}.part", self.tile + 1);
        self.block.0.path().join(name)
    }

    /// Makes the part, also where it is there.
    fn make(&self) -> Output {
        let _ = fs::remove_file(self.path());
        let tile = (self.tile + 1).to_string();
        let mut command = self.block.command();
        command.args(["tile", "few", &tile]).output().unwrap()
    }

    fn part(&self) -> Vec<u8> {
        fs::read(self.path()).unwrap()
    }
}

#[test]
fn a_tile_reads_its_own_photographs_and_the_first_bytes_of_the_others() {
    let block = Block::of(crate::common::synthetic_files());
    let few = FewViews::of(&block);
    assert_eq!(few.views().len(), 3);
    assert!(few.make().status.success());
    let sound = few.part();
    // The others are damaged, all but their first bytes and their length.
    let images = block.scene().join("images");
    let (read, others): (Vec<_>, Vec<_>) =
        (files_in(&images).into_iter()).partition(|(name, _)| few.reads(name));
    assert_eq!((read.len(), others.is_empty()), (3, false));
    for (name, bytes) in &others {
        fs::write(images.join(name), changed_at(bytes, 1.0)).unwrap();
    }
    let output = few.make();
    assert!(output.status.success(), "{}", words(&output));
    assert!(few.part() == sound);
    let (name, bytes) = &read[1];
    fs::write(images.join(name), changed_at(bytes, 1.0)).unwrap();
    let named = format!("{name}: the file has changed since the plan was made");
    block.is_refused(&few.make(), &[&named]);
    fs::write(images.join(name), bytes).unwrap();
    assert!(few.make().status.success() && few.part() == sound);
    // An archive is read as a whole, to the same results.
    for (name, bytes) in &others {
        fs::write(images.join(name), bytes).unwrap();
    }
    let archive = crate::common::zipped(&crate::common::synthetic_files());
    block.is_the_same_from(&archive);
}

/// The scene with its photographs as TIFFs, whose directories stand in every place in turn.
fn tiff_files() -> Vec<(String, Vec<u8>)> {
    let mut forms = crate::planted_tiff::forms().into_iter().cycle();
    let mut as_tiff = |(path, bytes): (String, Vec<u8>)| match image::load_from_memory(&bytes) {
        Ok(image) => {
            let form = forms.next().unwrap();
            let bytes = crate::planted_tiff::written(&image.into_rgb8(), form);
            (path.replace(".png", ".tif"), bytes)
        }
        Err(_) => {
            let text = String::from_utf8(bytes).unwrap();
            (path, text.replace(".png", ".tif").into_bytes())
        }
    };
    crate::common::synthetic_files()
        .into_iter()
        .map(&mut as_tiff)
        .collect()
}

#[test]
fn a_tile_reads_the_directories_of_tiffs_that_are_not_its_own() {
    let block = Block::of(tiff_files());
    let few = FewViews::of(&block);
    let images = block.scene().join("images");
    let head = |name: &str| {
        let mut inputs = few.plan["inputs"].as_array().unwrap().iter();
        let found = inputs.find(|input| input["file"] == format!("images/{name}"));
        found.unwrap()["head"]["bytes"].as_u64()
    };
    assert!(few.make().status.success());
    let sound = few.part();
    let [mut others, mut refused] = [0, 0];
    for (name, bytes) in files_in(&images) {
        let path = images.join(&name);
        // 64 kB, and at most the two blocks in which a directory stands.
        let head = head(&name).unwrap();
        assert!(
            head < bytes.len() as u64 && head <= (64 + 32) << 10,
            "{name}: {head}"
        );
        // A pixel between the first bytes and all directories.
        fs::write(&path, changed_at(&bytes, 0.75)).unwrap();
        let output = few.make();
        if few.reads(&name) && !output.status.success() {
            let named = format!("{name}: the file has changed since the plan was made");
            block.is_refused(&output, &[&named]);
            refused += 1;
        } else {
            // Another photograph, or a block of it that holds nothing of the window.
            assert!(output.status.success(), "{}", words(&output));
            assert!(few.part() == sound);
            others += 1;
            // Its directory says where it stands.
            let mut moved = bytes.clone();
            moved[crate::planted_tiff::directory_of(&bytes) + 30] ^= 1;
            fs::write(&path, moved).unwrap();
            let named = format!("{name}: the file has changed since the plan was made");
            block.is_refused(&few.make(), &[&named]);
        }
        fs::write(&path, bytes).unwrap();
    }
    assert!(others > 2 && refused > 0, "{others} {refused}");
    // The files of an archive are read whole, to the same results.
    let archive = crate::common::zipped(&tiff_files());
    block.is_the_same_from(&archive);
}

#[test]
fn a_killed_process_leaves_no_half_part_and_changes_no_byte() {
    let [of_tile, of_join] = reference().times;
    let block = Block::with_plan();
    let kill_after = |mut command: Command, time: Duration| {
        let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut process = quiet.spawn().unwrap();
        sleep(time);
        // On Unix this is SIGKILL. It may have ended by itself.
        process.kill().unwrap();
        process.wait().unwrap();
    };
    for share in [0.02, 0.3, 0.6, 0.85, 0.95, 1.0] {
        let _ = fs::remove_file(block.part(1));
        kill_after(block.tile_command(1), of_tile.mul_f64(share));
        let left = fs::read(block.part(1)).ok();
        assert!(
            left.is_none_or(|part| part == reference().parts[0]),
            "{share}"
        );
    }
    for tile in 1..=TILES {
        assert!(block.tile(tile).status.success());
    }
    // Neither is there anything else: what was begun is gone.
    let parts: Vec<Vec<u8>> = files_in(&block.folder().join("parts"))
        .into_values()
        .collect();
    assert!(parts == reference().parts);
    for share in [0.02, 0.5, 0.9, 1.0] {
        kill_after(block.join_command(), of_join.mul_f64(share));
        for (name, bytes) in files_in(&block.out()) {
            let is_begun = name.starts_with('.');
            assert!(
                is_begun || bytes == reference().model[&name],
                "{share}: {name}"
            );
        }
    }
    assert!(block.join().status.success());
    assert!(files_in(&block.out()) == reference().model);
}
