"""The shipped rigs, a TOML file each."""
