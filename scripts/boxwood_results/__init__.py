"""Reads Boxwood result files for figures and the report. Never measures, decides or writes one."""
