//! Opens models and records and writes results, whole or not at all.
//!
//! Reading gives bytes with their hash, or one clear error. Writing goes to a temporary file beside
//! the target, which is renamed when it is complete; whatever fails leaves no file behind, and a
//! handler of Ctrl-C may call [`remove_temporaries`].

mod error;
mod folder;
mod globs;
mod inputs;
mod kept;
mod laboratory;
mod load;
mod parquet;
mod read;
mod records;
mod run;
mod study;
mod suite;
mod table;
mod threads;
mod unfit;
mod write;

pub use error::FileError;
pub use folder::{FolderRecords, folder_records};
pub use globs::{expand, expand_all};
pub use inputs::InputFiles;
pub use kept::KeptFile;
pub use laboratory::{LaboratoryError, TextFile, read_mapping, read_measured};
pub use load::{
    AlongYRequest, LoadedMotion, RecordRequest, SourceFile, VerticalRequest, load_record,
};
pub use parquet::{UNIT_KEY, columns_to_bytes, read_columns, write_columns};
pub use read::{MAX_BYTES, modes_beside, read_at_most, read_bytes, resolve};
pub use records::{
    FileNames, RecordOptions, Wanted, WrittenFormat, channels, one_channel, open_record,
};
pub use run::{JobError, OpenJob, reading_time, record_path, time_left};
pub use slipstick_report::tables::{events_csv, history_csv};
pub use study::{
    Checks, Merged, OpenStudy, STUDY_REPORT, Shard, ShardOutcome, StudyError, TARGET, clear,
    conclude, estimate, files_of_runs, has_parts, kept_runs, limit_of_ida, merge, model_of_runs,
    part_rows, quoted, read_runs, read_target, run_shard,
};
pub use suite::{OpenSuite, ReadRecords, SuiteError, SuiteRequest, stems_or_paths};
pub use table::{ReadTable, read_csv, read_table, to_csv, to_parquet};
pub use threads::on_threads;
pub use write::{OutputFolder, refuse_inputs, remove_temporaries, write_whole};
