//! A folder for one test, and the command run in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde_json::Value;

/// A block on a spring under a sine of 5 s.
pub const BLOCK: &str = r#"name = "Block"

[block]
mass = "124 kg"

[slider]
static_friction = 0.165
kinetic_friction = 0.153
spring = "20 kN/m"

[motion]
sine = { frequency = "2 Hz", amplitude = "3 m/s2", duration = "5 s", dt = "0.01 s" }
"#;

/// A block that slides on the record named `record.csv`.
pub const RECORDED: &str = r#"[block]
mass = "124 kg"

[slider]
static_friction = 0.2
kinetic_friction = 0.1

[motion]
record = "record.csv"
"#;

/// A record that needs no other key.
pub const RECORD: &str = "time_s,acceleration_m_per_s2\n0,0\n1,5\n2,-5\n3,0\n";

/// A folder of its own for one test, removed at its end.
pub struct Folder(PathBuf);

impl Folder {
    /// An empty one.
    pub fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("slipstick-{}-{test}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    /// One with a model.
    pub fn with_model(test: &str, text: &str) -> Self {
        let folder = Self::new(test);
        folder.write("model.toml", text);
        folder
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Everything below the folder: files with their bytes, folders without.
    pub fn contents(&self) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut found = BTreeMap::new();
        let mut folders = vec![self.0.clone()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let name = path.strip_prefix(&self.0).unwrap().to_owned();
                if path.is_dir() {
                    found.insert(name, None);
                    folders.push(path);
                } else {
                    found.insert(name, Some(fs::read(path).unwrap()));
                }
            }
        }
        found
    }

    /// Names of everything below a folder of it.
    pub fn names(&self, under: &str) -> Vec<String> {
        let names = self.contents().into_keys();
        let below = names.filter_map(|name| Some(name.strip_prefix(under).ok()?.to_owned()));
        below.map(|name| name.display().to_string()).filter(|name| !name.is_empty()).collect()
    }

    /// Moves the parts of a study beside its manifest, where earlier versions wrote them.
    pub fn parts_to_old_layout(&self, out: &str) {
        let out = self.0.join(out);
        for entry in std::fs::read_dir(out.join("parts")).unwrap() {
            let entry = entry.unwrap();
            std::fs::rename(entry.path(), out.join(entry.file_name())).unwrap();
        }
        std::fs::remove_dir(out.join("parts")).unwrap();
    }

    /// The command with these arguments, to be run in the folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_slipstick"));
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub fn output(&self, arguments: &[&str]) -> Output {
        output(&mut self.command(arguments))
    }

    /// What it prints; it must end well.
    pub fn stdout(&self, arguments: &[&str]) -> String {
        let output = self.output(arguments);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
        text(&output.stdout)
    }

    /// The object that `--json` prints.
    pub fn json(&self, arguments: &[&str]) -> Value {
        let arguments = [&["run", "--json"], arguments].concat();
        serde_json::from_str(&self.stdout(&arguments)).unwrap()
    }

    /// The one message of a call that must be refused: status 2, nothing on standard output, nothing
    /// written, nothing touched.
    pub fn refused(&self, arguments: &[&str]) -> String {
        let before = self.contents();
        let output = self.output(arguments);
        assert_eq!(self.contents(), before, "{arguments:?} touched files");
        message(arguments, &output)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Held while a process is started: until it runs its own program it has a copy of every pipe of
/// this one, and a pipe of which there is a copy is not closed.
pub fn starting() -> MutexGuard<'static, ()> {
    static STARTING: Mutex<()> = Mutex::new(());
    STARTING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts a process, one at a time.
pub fn start(command: &mut Command) -> Child {
    let _one = starting();
    command.spawn().unwrap()
}

/// What a process prints, where its streams are pipes.
pub fn output(command: &mut Command) -> Output {
    start(command).wait_with_output().unwrap()
}

/// What a script of the shell prints.
#[cfg(unix)]
pub fn script(folder: &Folder, program: &[&str], script: &str) -> Output {
    let mut command = Command::new(program[0]);
    command.args(&program[1..]).args(["-c", script]).current_dir(folder.path());
    output(command.stdout(Stdio::piped()).stderr(Stdio::piped()))
}

/// The one message of a refusal.
pub fn message(arguments: &[&str], output: &Output) -> String {
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
    assert_eq!(text(&output.stdout), "", "{arguments:?}");
    let message = stderr.strip_prefix("error: ").unwrap_or_else(|| panic!("{stderr:?}"));
    let message = message.strip_suffix('\n').unwrap_or_else(|| panic!("{stderr:?}"));
    let one = message.lines().filter(|line| !line.is_empty()).all(|line| !line.contains("error:"));
    assert!(one && message.trim() == message && !message.is_empty(), "{stderr:?}");
    message.to_owned()
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A column of a CSV file, by its name.
pub fn column(csv: &str, name: &str) -> Vec<f64> {
    cells(csv, name).iter().map(|cell| cell.parse().unwrap()).collect()
}

/// A column of a CSV file as it is written.
pub fn cells(csv: &str, name: &str) -> Vec<String> {
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let index = header.iter().position(|column| *column == name);
    let index = index.unwrap_or_else(|| panic!("no column {name} in {header:?}"));
    lines.map(|line| line.split(',').nth(index).unwrap().to_owned()).collect()
}
