"""``python -m symrot``, and the command ``symrot``."""

__all__ = ["main"]


def main() -> int:
    """Run the command line; Ctrl-C while it is still being imported ends it as quietly as later."""
    try:
        from symrot.cli.interrupt import repeat_lost_interrupts

        repeat_lost_interrupts()
        from symrot.cli import main as cli

        return cli.main()
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    raise SystemExit(main())
