//! The page: its module, its scripts, a small server to look at it.

use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};

use crate::shell::{self, Outcome};

/// The folder of the page's sources.
pub const PAGE: &str = "crates/web/page";

const WASM: &str = "wasm32-unknown-unknown";

/// Builds the page into `web` of the target folder; serves it where asked to.
pub fn web(options: &[&str]) -> Outcome {
    let serve = match options {
        [] => false,
        ["--serve"] => true,
        _ => return Err("web: expected [--serve]".to_owned()),
    };
    let folder = build()?;
    eprintln!("wrote {}", folder.display());
    if serve { self::serve(&folder) } else { Ok(()) }
}

/// What building the page needs and is not there; a sentence.
pub fn missing() -> Option<String> {
    if !shell::answers("node", "--version") {
        return Some("expected node (20 or later), found none".to_owned());
    }
    let npm = shell::answers(npm(), "--version");
    (!npm).then(|| "expected npm, which comes with node, found none".to_owned())
}

fn npm() -> &'static str {
    if cfg!(windows) { "npm.cmd" } else { "npm" }
}

/// Builds the page and returns its folder.
pub fn build() -> Result<PathBuf, String> {
    if let Some(missing) = missing() {
        return Err(format!("web: {missing}"));
    }
    add_target()?;
    let build = format!("build --package slipstick-web --profile web --target {WASM}");
    shell::run(&mut shell::cargo(&build))?;
    let target = shell::target_folder()?;
    let module = target.join(WASM).join("web/slipstick_web.wasm");
    let page = shell::root().join(PAGE);
    let bindgen = "run --quiet --package xtask --features bindgen --bin bindgen --";
    shell::run(shell::cargo(bindgen).arg(&module).arg(page.join("pkg")))?;
    packages(&page)?;
    let folder = target.join("web");
    shell::run(shell::command("node").arg(page.join("build.mjs")).arg(&folder))?;
    Ok(folder)
}

/// Adds the target for WebAssembly where it is missing.
fn add_target() -> Outcome {
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
