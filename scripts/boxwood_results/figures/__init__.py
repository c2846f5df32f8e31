"""One module per figure: NAME, TITLE, HOW_TO_READ and draw(run); the registry lists them."""
