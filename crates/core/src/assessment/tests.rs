mod certified;
mod choice;
mod fits;
mod hunts;
mod runs;
mod travel;
