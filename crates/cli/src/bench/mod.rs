use crate::args::BenchArgs;
use crate::error::CliError;
pub(crate) fn run(_: &BenchArgs) -> Result<(), CliError> {
    Ok(())
}
