"""The command line of symrot: parsing of arguments, the commands, their output and exit codes."""
