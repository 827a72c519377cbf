"""The interaction sub-system (III-B): behaviour selection, persuasion, facilitation."""
