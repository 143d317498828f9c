//! How the command ends where its surroundings fail: closed pipes, full disks, Ctrl-C.
#![cfg(unix)]

use std::fs::File;
use std::io::Write;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use super::support::{BLOCK, Folder, message, output, script, start, starting, text};

/// Every command that prints much.
const PRINTING: [&[&str]; 6] = [
    &["run", "model.toml"],
    &["run", "model.toml", "--json"],
    &["schema"],
    &["schema", "--units"],
    &["completions", "bash"],
    &["help", "run"],
];

#[test]
fn closed_pipe_is_silent() {
    // A gap that is passed gives a warning, which must not be heard either.
    let model = BLOCK.replace("[slider]", "[slider]\ngap = \"1 mm\"");
    let folder = Folder::with_model("pipe", &model);
    let runs: [&[&str]; 2] = [&["run", "-"], &["run", "-", "--json"]];
    for arguments in runs.iter().chain(&PRINTING) {
        let mut command = folder.command(arguments);
        let one = starting();
        let mut child = command.stdin(Stdio::piped()).spawn().unwrap();
        drop((child.stdout.take(), one));
        // Only now has it a model to run. Commands that read none may be gone.
        let _ = child.stdin.take().unwrap().write_all(model.as_bytes());
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        if arguments.contains(&"-") {
            assert_eq!(text(&output.stderr), "", "{arguments:?}");
        }
    }
    let schema = format!("{} schema | head -1", env!("CARGO_BIN_EXE_slipstick"));
    let output = script(&folder, &["sh"], &schema);
    assert_eq!(text(&output.stdout).lines().count(), 1);
    assert_eq!(text(&output.stderr), "");
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_full() {
    let folder = Folder::with_model("stdout-full", BLOCK);
    for arguments in PRINTING {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = output(folder.command(arguments).stdout(full));
        let found = message(arguments, &output);
        assert_eq!(found, "standard output: cannot be written: no space left on the device");
    }
    // Nobody can be told anything: that changes nothing else.
    for (arguments, status) in
        [(&["run", "model.toml", "--out", "out"], 0), (&["run", "x", "-o", "y"], 2)]
    {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = output(folder.command(arguments).stderr(full));
        assert_eq!(output.status.code(), Some(status));
    }
}

/// A limit on the size of files stops a write in its middle, as a full disk does.
#[test]
fn write_that_stops_in_the_middle_leaves_nothing() {
    let folder = Folder::with_model("limit", BLOCK);
    folder.write("old/summary.json", "older");
    for out in ["new/out", "old"] {
        let before = folder.contents();
        let run = format!("exec {} run model.toml --out {out}", env!("CARGO_BIN_EXE_slipstick"));
        let limited = format!("trap '' XFSZ; ulimit -f 16; {run}");
        let output = script(&folder, &["sh"], &limited);
        let found = message(&["run"], &output);
        assert!(found.starts_with(&format!("{out}/history.csv: cannot be written: ")), "{found}");
        assert_eq!(folder.contents(), before);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn full_disk_leaves_nothing() {
    let folder = Folder::with_model("disk", BLOCK);
    folder.write("disk/.keep", "");
    // A file system of its own, seen by this shell only.
    let in_disk = |run: &str| {
        let run = format!("mount -t tmpfs -o size=48k tmpfs disk && {run}");
        script(&folder, &["unshare", "--user", "--map-root-user", "--mount", "sh"], &run)
    };
    if missing("unshare") || !in_disk("true").status.success() {
        println!("skipped: full disk (no file system of its own can be mounted here)");
        return;
    }
    let run = format!("{} run model.toml --out disk/out", env!("CARGO_BIN_EXE_slipstick"));
    let output = in_disk(&format!("{{ {run}; echo $?; ls -A disk; }}"));
    assert_eq!(text(&output.stdout), "2\n");
    assert_eq!(
        text(&output.stderr),
        "error: disk/out/history.csv: cannot be written: no space left on the device\n"
    );
}

/// Whether a program is not to be had.
#[cfg(target_os = "linux")]
fn missing(program: &str) -> bool {
    let _one = starting();
    Command::new(program).arg("--version").output().is_err()
}

/// Runs until `when` and sends Ctrl-C; what was printed by then.
fn sent_an_interrupt(
    folder: &Folder,
    arguments: &[&str],
    when: impl Fn(&Folder) -> bool,
) -> Output {
    let child = start(&mut folder.command(arguments));
    let started = Instant::now();
    while !when(folder) {
        assert!(started.elapsed() < Duration::from_secs(300), "nothing to interrupt");
        std::thread::sleep(Duration::from_millis(2));
    }
    let mut kill = start(Command::new("kill").args(["-INT", &child.id().to_string()]));
    assert!(kill.wait().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    output
}

/// Interrupts a run when `when` holds, and expects a folder as it was.
fn interrupted(folder: &Folder, arguments: &[&str], when: impl Fn(&Folder) -> bool) {
    let before = folder.contents();
    let output = sent_an_interrupt(folder, arguments, when);
    assert_eq!((text(&output.stdout), text(&output.stderr)), (String::new(), String::new()));
    assert_eq!(folder.contents(), before);
}

#[test]
fn interrupt_leaves_nothing_behind() {
    let long = BLOCK.replace("5 s", "4000 s");
    let folder = Folder::with_model("interrupt", &long);
    // The folder is made before the analysis starts.
    let made = |folder: &Folder| folder.path().join("new/out").is_dir();
    interrupted(&folder, &["run", "model.toml", "--out", "new/out"], made);
    folder.write("old/summary.json", "older");
    let writing = |folder: &Folder| {
        let entries = std::fs::read_dir(folder.path().join("old")).unwrap();
        let mut names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.any(|name| name.starts_with(".history.csv"))
    };
    interrupted(&folder, &["run", "model.toml", "--out", "old"], writing);
}

/// An analysis or a suite of pairs that is interrupted says what it has kept, and the same command goes on with that to the
/// same result.
#[test]
fn interrupted_pairs_go_on() {
    let model = "[block]\nmass = \"100 t\"\n[slider]\nstatic_friction = 0.06\nkinetic_friction = 0.05\n\
                 radius = \"2 m\"\n[[storey]]\nmass = \"50 t\"\nperiod = \"0.5 s\"\ndamping_ratio = 0.02\n";
    let folder = Folder::with_model("pairs-go-on", model);
    let records = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/records");
    let [x, y] = ["taft-021.txt", "taft-111.txt"]
        .map(|name| std::fs::read_to_string(format!("{records}/{name}")).unwrap());
    for i in 0..20 {
        folder.write(&format!("{i:02}-x.txt"), &x);
        folder.write(&format!("{i:02}-y.txt"), &y);
    }
    let levels =
        (1..=80).map(|i| format!("{} g", 0.05 * f64::from(i))).collect::<Vec<_>>().join(", ");
    let read = ["--units", "g", "--dt", "0.01 s", "-j", "1", "-q"];
    let of_one = ["ida", "model.toml", "--records", "00-x.txt", "--second", "00-y.txt"];
    let ida = [&of_one[..], &read, &["--scale-to", &levels, "--limit", "0.3 m"]].concat();
    let all = ["run", "model.toml", "--records", "*-x.txt", "--second", "*-y.txt"];
    let suite =
        [&all[..], &read, &["--set", "slider.bounds={ lower = 0.8, upper = 1.2 }"]].concat();
    for (name, command, runs) in [("ida", ida, 80), ("suite", suite, 60)] {
        let (begun_in, whole) = (format!("{name}-out"), format!("{name}-whole"));
        let to = |out: &'_ str| [&command[..], &["--out", out]].concat().join("\n");
        fn words(of: &str) -> Vec<&str> {
            of.split('\n').collect()
        }
        let path = folder.path().join(&begun_in).join("runs.kept");
        let kept = || std::fs::read_to_string(&path).unwrap_or_default();
        let begun = |_: &Folder| kept().lines().count() >= 3;
        let output = sent_an_interrupt(&folder, &words(&to(&begun_in)), begun);
        let said = text(&output.stderr);
        let go_on = format!("are kept in {begun_in}; the same command goes on with them");
        assert!(said.contains(&go_on), "{said}");
        let count = kept().lines().count();
        assert!((3..runs).contains(&count), "{count} runs were kept");
        folder.stdout(&words(&to(&begun_in)));
        folder.stdout(&words(&to(&whole)));
        let summary = |out: &str| folder.read(&format!("{out}/summary.json"));
        assert_eq!(summary(&begun_in), summary(&whole));
        assert_eq!(kept(), "", "the results stand for their runs");
    }
}
