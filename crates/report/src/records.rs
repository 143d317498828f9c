//! Records as people and programs read them: the list of channels, their spectra, their figures.

mod figures;
mod info;
mod page;
mod spectra;

pub use figures::{Histories, Husid, figures, spectrum_figures};
pub use info::{ChannelInfo, info_json, info_table};
pub use page::page;
pub use spectra::{
    ChannelFourier, ChannelSpectrum, fourier_csv, fourier_table, spectra_csv, spectra_json,
    spectrum_table,
};
