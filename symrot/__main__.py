"""Entry point of ``python -m symrot`` and of the command ``symrot``."""

__all__ = ["main"]


def main() -> int:
    """Run the command line and return its exit code.

    Ctrl-C ends the program without a traceback, even while modules are still being imported.
    """
    try:
        from symrot.cli.interrupt import end_quietly, is_interrupt, note_interrupts, repeat_lost_interrupts
    except KeyboardInterrupt:
        return 130
    try:
        note_interrupts()
        repeat_lost_interrupts()
        from symrot.cli import main as cli

        code = cli.main()
        if code == 130:
            end_quietly()
        return code
    except BaseException as error:
        if is_interrupt(error):
            return 130
        raise


if __name__ == "__main__":
    raise SystemExit(main())
