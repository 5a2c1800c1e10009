"""Error against run time, part by part: what is measured, and what the benchmark records of it."""
