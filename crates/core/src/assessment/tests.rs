mod choice;
mod fits;
mod hunts;
