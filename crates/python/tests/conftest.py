"""What pytest leaves out."""

# Read by pyright and mypy, not run: its files are a user's.
collect_ignore = ["typical_use.py"]
