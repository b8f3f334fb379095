//! The program `subdiv`: see `subdiv --help`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
