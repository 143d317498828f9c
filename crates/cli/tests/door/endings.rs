//! How the command ends where its surroundings fail: closed pipes, full disks, Ctrl-C.
#![cfg(unix)]

use std::fs::File;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::support::{BLOCK, Folder, message, text};

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
fn exact_closed_pipe_is_silent() {
    // A gap that is passed gives a warning, which must not be heard either.
    let folder = Folder::with_model("pipe", &BLOCK.replace("[slider]", "[slider]\ngap = \"1 mm\""));
    for arguments in PRINTING {
        let mut command = folder.command(arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let stderr = text(&output.stderr);
        assert_eq!((output.status.code(), stderr.as_str()), (Some(0), ""), "{arguments:?}");
    }
    let script = format!("{} schema | head -1", env!("CARGO_BIN_EXE_slipstick"));
    let output = Command::new("sh").args(["-c", &script]).output().unwrap();
    assert_eq!(text(&output.stdout).lines().count(), 1);
    assert_eq!(text(&output.stderr), "");
}

#[cfg(target_os = "linux")]
#[test]
fn exact_standard_output_that_is_full() {
    let folder = Folder::with_model("stdout-full", BLOCK);
    for arguments in PRINTING {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = folder.command(arguments).stdout(full).output().unwrap();
        let found = message(arguments, &output);
        assert_eq!(found, "standard output: cannot be written: no space left on the device");
    }
    // Nobody can be told anything: that changes nothing else.
    for (arguments, status) in
        [(&["run", "model.toml", "--out", "out"], 0), (&["run", "x", "-o", "y"], 2)]
    {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let output = folder.command(arguments).stderr(full).output().unwrap();
        assert_eq!(output.status.code(), Some(status));
    }
}

/// A limit on the size of files stops a write in its middle, as a full disk does.
#[test]
fn exact_write_that_stops_in_the_middle_leaves_nothing() {
    let folder = Folder::with_model("limit", BLOCK);
    folder.write("old/summary.json", "older");
    for out in ["new/out", "old"] {
        let before = folder.contents();
        let run = format!("exec {} run model.toml --out {out}", env!("CARGO_BIN_EXE_slipstick"));
        let script = format!("trap '' XFSZ; ulimit -f 16; {run}");
        let output =
            Command::new("sh").args(["-c", &script]).current_dir(folder.path()).output().unwrap();
        let found = message(&["run"], &output);
        assert!(found.starts_with(&format!("{out}/history.csv: cannot be written: ")), "{found}");
        assert_eq!(folder.contents(), before);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn exact_full_disk_leaves_nothing() {
    let folder = Folder::with_model("disk", BLOCK);
    folder.write("disk/.keep", "");
    // A file system of its own, seen by this shell only.
    let in_disk = |script: &str| {
        let script = format!("mount -t tmpfs -o size=48k tmpfs disk && {script}");
        let mut unshare = Command::new("unshare");
        unshare.args(["--user", "--map-root-user", "--mount", "sh", "-c", &script]);
        unshare.current_dir(folder.path()).output()
    };
    if !in_disk("true").is_ok_and(|output| output.status.success()) {
        println!("skipped: full disk (no file system of its own can be mounted here)");
        return;
    }
    let run = format!("{} run model.toml --out disk/out", env!("CARGO_BIN_EXE_slipstick"));
    let output = in_disk(&format!("{{ {run}; echo $?; ls -A disk; }}")).unwrap();
    assert_eq!(text(&output.stdout), "2\n");
    assert_eq!(
        text(&output.stderr),
        "error: disk/out/history.csv: cannot be written: no space left on the device\n"
    );
}

/// Runs until `when`, sends Ctrl-C, and expects a folder as it was.
fn interrupted(folder: &Folder, arguments: &[&str], when: impl Fn(&Folder) -> bool) {
    let before = folder.contents();
    let mut command = folder.command(arguments);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let started = Instant::now();
    while !when(folder) {
        assert!(started.elapsed() < Duration::from_secs(300), "nothing to interrupt");
        std::thread::sleep(Duration::from_millis(2));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    assert_eq!((text(&output.stdout), text(&output.stderr)), (String::new(), String::new()));
    assert_eq!(folder.contents(), before);
}

#[test]
fn exact_interrupt_leaves_nothing_behind() {
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
