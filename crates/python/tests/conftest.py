"""What pytest leaves out."""

# What users write: typical use is read by pyright and mypy, not run, for its files are a user's; test_day.py runs the rest.
collect_ignore = ["typical_use.py", "day"]
