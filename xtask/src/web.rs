//! The page: its module, its scripts, a small server to look at it.

use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};

use crate::shell::{self, Outcome};

/// The folder of the page's sources.
pub const PAGE: &str = "crates/web/page";

/// The same bundle for notebooks, where the Python package takes it from.
const WIDGET: &str = "crates/python/python/slipstick/page.js";

const WASM: &str = "wasm32-unknown-unknown";

/// The profile of WebAssembly for tests.
const TESTED: &str = "tested";

/// Packages of the page's modules: that of the first picture, and the whole one.
const MODULES: [&str; 2] = ["slipstick-first", "slipstick-web"];

/// Builds the page into `web` of the target folder; serves it where asked to.
pub fn web(options: &[&str]) -> Outcome {
    let serve = match options {
        [] => false,
        ["--serve"] => true,
        _ => return Err("web: expected [--serve]".to_owned()),
    };
    let folder = build(Build::Page)?;
    eprintln!("wrote {}", folder.display());
    if serve { self::serve(&folder) } else { Ok(()) }
}

/// A measured figure, and what it must keep.
struct Bar {
    what: &'static str,
    bar: &'static str,
    found: String,
    kept: bool,
}

/// Measures the page in Chromium; `--write` puts the table into the book.
pub fn bench(options: &[&str]) -> Outcome {
    let write = match options {
        [] => false,
        ["--write"] => true,
        _ => return Err("bench-web: expected [--write]".to_owned()),
    };
    let chromium = chromium().map_err(|reason| format!("bench-web: {reason}"))?;
    let folder = build(Build::Page)?;
    let mut bars = shell::command("node");
    bars.arg(shell::root().join(PAGE).join("tests/bars.mjs")).arg(&folder);
    let text = shell::output(bars.env("SLIPSTICK_CHROMIUM", chromium))?;
    let found: serde_json::Value =
        serde_json::from_str(&text).map_err(|error| format!("bars.mjs: {error}"))?;
    let native = "run --release --quiet --package slipstick --example histories";
    let native = shell::output(&mut shell::cargo(native))?;
    let native_ms: f64 = native.trim().parse().map_err(|error| format!("histories: {error}"))?;
    let number = |key: &str| found[key].as_f64().unwrap_or(f64::NAN);
    let history_ms = number("history_ms");
    let bar = |what, bar, found, kept| Bar { what, bar, found, kept };
    let (updates, within) = (number("updates_per_s"), number("frames_within"));
    let bars = [
        bar(
            "first picture, local host",
            "1 s",
            format!("{:.2} s", number("first_s")),
            number("first_s") <= 1.0,
        ),
        bar(
            "first picture, 1.6 Mbit/s, processor 4 × slower",
            "4 s",
            format!("{:.2} s", number("slow_first_s")),
            number("slow_first_s") <= 4.0,
        ),
        bar(
            "… what came before it, gzipped",
            "350 kB",
            format!("{:.0} kB", number("slow_first_kB")),
            number("slow_first_kB") <= 350.0,
        ),
        bar(
            "… first answer computed here, not yet checked",
            "6 s",
            format!("{:.2} s", number("slow_live_s")),
            number("slow_live_s") <= 6.0,
        ),
        bar(
            "… certified",
            "12 s",
            format!("{:.2} s", number("slow_certified_s")),
            number("slow_certified_s") <= 12.0,
        ),
        bar(
            "slider dragged for 4 s: updates a second",
            "55",
            format!("{updates:.0}"),
            updates >= 55.0,
        ),
        bar("… frames within 33 ms", "95 %", format!("{within:.0} %"), within >= 95.0),
        bar(
            "certified after the value rests",
            "100 ms",
            format!("{:.0} ms", number("certified_ms")),
            number("certified_ms") <= 100.0,
        ),
        bar(
            "history in WebAssembly over native",
            "2 ×",
            format!("{:.2} × ({history_ms:.3} ms, {native_ms:.3} ms)", history_ms / native_ms),
            history_ms <= 2.0 * native_ms,
        ),
        bar(
            "friction sweep of 1000 runs, one worker",
            "0.5 s",
            format!("{:.2} s", number("sweep_s")),
            number("sweep_s") <= 0.5,
        ),
        bar(
            "folder, gzipped: both modules, scripts, the built picture",
            "2600 kB",
            format!("{:.0} kB", number("folder_kB")),
            number("folder_kB") <= 2600.0,
        ),
        bar(
            "`slipstick.html`: the whole module and the scripts, packed",
            "2.4 MB",
            format!("{:.2} MB", number("single_MB")),
            number("single_MB") <= 2.4,
        ),
    ];
    let mut table = format!(
        "| what (Chromium {}) | bar | measured | |\n|---|--:|--:|---|\n",
        found["chromium"].as_str().unwrap_or_default()
    );
    for Bar { what, bar, found, kept } in &bars {
        let missed = if *kept { "" } else { "missed" };
        table.push_str(&format!("| {what} | {bar} | {found} | {missed} |\n"));
    }
    print!("{table}");
    if write {
        shell::write(&shell::root().join("book/src/generated/web.md"), &table)?;
    }
    Ok(())
}

/// What building the page needs and is not there; a sentence.
pub fn missing() -> Option<String> {
    if !shell::answers("node", "--version") {
        return Some("expected node (20 or later), found none".to_owned());
    }
    let npm = shell::answers(npm(), "--version");
    (!npm).then(|| "expected npm, which comes with node, found none".to_owned())
}

/// Chromium or Chrome, where it usually is; `SLIPSTICK_CHROMIUM` names another.
///
/// # Errors
/// A sentence where there is none.
pub fn chromium() -> Result<String, String> {
    if let Ok(named) = std::env::var("SLIPSTICK_CHROMIUM") {
        return Ok(named);
    }
    const MACOS: &str = "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome";
    let paths = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome", MACOS];
    let found = paths.into_iter().find(|path| Path::new(path).is_file());
    found.map(str::to_owned).ok_or_else(|| "expected Chromium, found none".to_owned())
}

fn npm() -> &'static str {
    if cfg!(windows) { "npm.cmd" } else { "npm" }
}

/// How the page's modules are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// With everything else for WebAssembly, as tests are built.
    Tested,
    /// As the page is handed out.
    Page,
}

/// Builds all that is built for WebAssembly as tests are, once: the libraries, the page's modules, and the example
/// that compares bits, whose module is returned.
///
/// # Errors
/// What does not build.
pub fn build_for_tests(golden: &str) -> Result<PathBuf, String> {
    let packages = modules();
    let build = format!(
        "build --quiet --lib --example golden --package slipstick --package slipstick-report {packages} \
         --profile {TESTED} --target {WASM}"
    );
    // The example compares its own bits with these, and returns the first that differs.
    shell::run(shell::cargo(&build).env("SLIPSTICK_GOLDEN", golden))?;
    Ok(shell::target_folder()?.join(WASM).join(TESTED).join("examples/golden.wasm"))
}

/// Puts the page together and returns its folder; the modules for tests are those that are there.
pub fn build(how: Build) -> Result<PathBuf, String> {
    if let Some(missing) = missing() {
        return Err(format!("web: {missing}"));
    }
    add_target()?;
    let profile = match how {
        Build::Tested => TESTED,
        Build::Page => {
            let build = format!("build {} --profile page --target {WASM}", modules());
            shell::run(&mut shell::cargo(&build))?;
            "page"
        }
    };
    let target = shell::target_folder()?;
    let page = shell::root().join(PAGE);
    for name in MODULES.map(|name| name.replace('-', "_")) {
        let module = target.join(WASM).join(profile).join(format!("{name}.wasm"));
        let bindgen = "run --quiet --package xtask --features bindgen --bin bindgen --";
        shell::run(shell::cargo(bindgen).arg(&module).arg(page.join("pkg")))?;
    }
    packages(&page)?;
    let folder = target.join(if how == Build::Page { "web" } else { "web-tested" });
    let mut put_together = shell::command("node");
    put_together.arg(page.join("build.mjs")).arg(&folder).arg(shell::root().join(WIDGET));
    shell::run(&mut put_together)?;
    Ok(folder)
}

/// The page's modules, as cargo is asked for them.
fn modules() -> String {
    MODULES.map(|module| format!("--package {module}")).join(" ")
}

/// Adds the target for WebAssembly where it is missing.
///
/// # Errors
/// That it cannot be added.
pub fn add_target() -> Outcome {
    let mut probe = shell::command("rustc");
    let installed = shell::output(probe.args(["--print", "target-libdir", "--target", WASM]))
        .is_ok_and(|folder| Path::new(folder.trim()).is_dir());
    if installed {
        return Ok(());
    }
    shell::run(shell::command("rustup").args(["target", "add", WASM]))
        .map_err(|reason| format!("web: the target {WASM} is missing; {reason}"))
}

/// Installs what package-lock.json names, unless it is there.
fn packages(page: &Path) -> Outcome {
    let (wanted, installed) =
        (page.join("package-lock.json"), page.join("node_modules/.slipstick-lock.json"));
    let read = |path: &Path| std::fs::read_to_string(path).ok();
    if read(&wanted).is_some() && read(&wanted) == read(&installed) {
        return Ok(());
    }
    let mut ci = shell::command(npm());
    ci.current_dir(page).args(["ci", "--no-audit", "--no-fund", "--ignore-scripts", "--silent"]);
    shell::run(&mut ci)?;
    std::fs::copy(&wanted, &installed)
        .map(|_| ())
        .map_err(|error| format!("{}: {error}", installed.display()))
}

/// Shows a folder on this machine alone until it is stopped.
fn serve(folder: &Path) -> Outcome {
    let fail = |error: std::io::Error| format!("web --serve: {error}");
    let listener = TcpListener::bind(("127.0.0.1", 8080))
        .or_else(|_| TcpListener::bind(("127.0.0.1", 0)))
        .map_err(fail)?;
    let address = format!("http://{}/", listener.local_addr().map_err(fail)?);
    eprintln!("{address} (Ctrl-C ends it)");
    let open = if cfg!(windows) {
        "explorer"
    } else if cfg!(target_os = "macos") {
        "open"
    } else {
        "xdg-open"
    };
    // Where there is no window to open, the address stands above.
    let _ = shell::command(open).arg(&address).stderr(std::process::Stdio::null()).spawn();
    for stream in listener.incoming() {
        let (stream, folder) = (stream.map_err(fail)?, folder.to_owned());
        std::thread::spawn(move || {
            // A browser that goes away is no fault.
            let _ = answer(stream, &folder);
        });
    }
    Ok(())
}

fn answer(mut stream: TcpStream, folder: &Path) -> std::io::Result<()> {
    let mut lines = BufReader::new(&stream).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    while lines.next().transpose()?.is_some_and(|line| !line.is_empty()) {}
    let path = request.split(' ').nth(1).unwrap_or("/");
    let path = path.split(['?', '#']).next().unwrap_or("/").trim_start_matches('/');
    let name = if path.is_empty() { "index.html" } else { path };
    let plain = !name.contains("..") && !name.contains(['/', '\\']);
    let data = if plain { std::fs::read(folder.join(name)).ok() } else { None };
    let kind = match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("webmanifest") => "application/manifest+json",
        _ => "text/plain; charset=utf-8",
    };
    let (status, body) = match data {
        Some(data) => ("200 OK", data),
        None => ("404 Not Found", b"not found".to_vec()),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n\
         X-Content-Type-Options: nosniff\r\nCache-Control: no-cache\r\nConnection: close\r\n\r\n",
        body.len()
    )?;
    stream.write_all(&body)
}
