"""The meaning of words, typed or spoken: phrases, commands, stop, and pronunciation."""
