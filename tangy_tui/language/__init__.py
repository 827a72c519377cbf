"""Language understanding, typed or spoken: phrases, commands, stop, and pronunciation."""
