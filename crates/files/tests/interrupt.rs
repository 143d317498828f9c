//! What Ctrl-C does; alone in its process, as nothing can be written after it.
#![allow(clippy::unwrap_used)]

use std::fs;

use slipstick_files::{FileError, OutputFolder, remove_temporaries, write_whole};

#[test]
fn interrupt_leaves_nothing_behind() {
    let folder = std::env::temp_dir().join(format!("slipstick-interrupt-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let mut output = OutputFolder::create(&folder.join("new/out"), &[]).unwrap();
    output.write("a.txt", b"a").unwrap();
    remove_temporaries();
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
    // The rest of the program runs on until it is ended: it can do no harm.
    assert!(matches!(output.write("b.txt", b"b"), Err(FileError::Write { .. })));
    assert!(output.commit().is_err());
    assert!(write_whole(&folder.join("c.txt"), b"c").is_err());
    assert!(OutputFolder::create(&folder.join("again"), &[]).is_err());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
    fs::remove_dir(&folder).unwrap();
}
