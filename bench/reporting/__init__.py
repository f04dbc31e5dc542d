"""The parts of the report that bench/report.py writes: each says what to run and turns the results into tables and plots."""
