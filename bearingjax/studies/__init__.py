"""Runs that scenes describe: a folder each with reader, run, report, command line."""
