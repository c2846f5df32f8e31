"""Reads Boxwood result files: statistics, figures, report. Never measures, never writes one."""
