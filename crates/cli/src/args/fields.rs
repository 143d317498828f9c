//! Fields of requests as options.

use clap::builder::PossibleValuesParser;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};
use slipstick::error::ChoiceError;
use slipstick::requests::{Field, FrontEnd, Kind, Request, Takes};

use crate::failure::Failure;

/// Fields of ground motions.
const MOTION: [&str; 5] = ["measure", "scale", "scale-to", "code-spectrum", "periods"];

/// The fields of a request, by its place in [`Kind::ALL`], as options.
#[derive(Clone, Debug)]
pub struct Fields<const KIND: usize>(Vec<(&'static str, String)>);

impl<const KIND: usize> Fields<KIND> {
    /// What is asked for.
    pub fn asked(&self) -> Result<Request, ChoiceError> {
        Request::new(Kind::ALL[KIND], self.0.iter().cloned())
    }

    /// Whether a field is given.
    pub fn has(&self, name: &str) -> bool {
        self.0.iter().any(|(given, _)| *given == name)
    }

    /// Refuses what is given and is no field of another request that is made instead; `expected` is what would
    /// make it one.
    pub fn none_beside(&self, other: Kind, expected: &str) -> Result<(), Failure> {
        let of_other = |name: &str| other.fields().iter().any(|field| field.name == name);
        match self.0.iter().find(|(name, _)| !of_other(name)) {
            None => Ok(()),
            Some((name, _)) => {
                let option = FrontEnd::Command.calls(name);
                Err(Failure::Message(format!("{option}: expected {expected}")))
            }
        }
    }
}

/// The option of a field.
fn option(field: &'static Field) -> Arg {
    let arg = Arg::new(field.name)
        .long(field.name)
        .value_name(field.value)
        .help(field.about)
        .help_heading(MOTION.contains(&field.name).then_some("Ground motion"));
    let arg = if field.formerly.is_empty() { arg } else { arg.alias(field.formerly) };
    let arg = match field.takes {
        Takes::Flag => return arg.action(ArgAction::SetTrue),
        Takes::Many => arg.action(ArgAction::Append),
        Takes::One => arg.action(ArgAction::Set),
        Takes::Choice(words) => arg.value_parser(PossibleValuesParser::new(words)),
    };
    let arg = arg.allow_negative_numbers(true);
    if field.default.is_empty() { arg } else { arg.default_value(field.default) }
}

impl<const KIND: usize> Args for Fields<KIND> {
    fn augment_args(command: Command) -> Command {
        // Requests of one command share options.
        let new =
            |field: &&Field| command.get_arguments().all(|known| known.get_id() != field.name);
        let new: Vec<Arg> = Kind::ALL[KIND].fields().iter().filter(new).map(option).collect();
        command.args(new)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<const KIND: usize> FromArgMatches for Fields<KIND> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let typed =
            |field: &&Field| matches.value_source(field.name) == Some(ValueSource::CommandLine);
        let texts = |field: &'static Field| {
            if field.takes == Takes::Flag {
                return vec![(field.name, matches.get_flag(field.name).to_string())];
            }
            let texts = matches.get_many::<String>(field.name).into_iter().flatten();
            texts.map(|text| (field.name, text.clone())).collect::<Vec<_>>()
        };
        Ok(Self(Kind::ALL[KIND].fields().iter().filter(typed).flat_map(texts).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
