"""Numbers in words, and the words that columns of few may hold (results/words.h has the same)."""

PHASES = ("", "build", "cold_build", "update", "query", "upload", "device_build", "device_query", "download",
          "build+query", "update+query")
STATUSES = ("unchecked", "exact", "conservative", "within_bound", "unsupported", "wrong")
FAMILIES = ("", "peers", "ours", "threads", "stages")
TOPICS = ("", "race", "kernel", "scene")
VERDICTS = ("", "faster", "slower", "same", "cannot_tell", "wrong")
REASONS = ("", "too_few_rounds", "below_the_floor", "crosses_1", "unchecked", "too_noisy")


def ratio_text(value, times="x"):
    digits = 0 if value >= 100 else 1 if value >= 10 else 2
    return f"{value:,.{digits}f}{times}"


def interval_text(ratio):
    """One figure with its interval: '3.12x (2.98 to 3.20)'."""
    text = ratio_text(ratio.mid)
    return f"{text} ({ratio_text(ratio.lo, '')} to {ratio_text(ratio.hi, '')})" if ratio.known else text


def time_text(ns):
    """Three digits with the unit that suits: '12.3 ms'."""
    if ns != ns:
        return "-"
    for limit, unit, scale in ((1e3, "ns", 1), (1e6, "µs", 1e3), (1e9, "ms", 1e6)):
        if ns < limit * 0.9995:
            break
    else:
        unit, scale = "s", 1e9
    return f"{ns / scale:.3g} {unit}" if ns / scale < 999.5 else f"{ns / scale:,.0f} {unit}"
