from btq_lang.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
