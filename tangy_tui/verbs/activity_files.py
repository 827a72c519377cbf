"""The files of a new activity, from the answers of its author."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_tui.app import activity_bases as bases
from tangy_tui.app import new_activity as new
from tangy_tui.app.authors_words import listed_answers
from tangy_tui.app.new_activity import Draft
from tangy_tui.app.question_files import ChoiceQuestion, questions_table
from tangy_tui.text import activity_questions as words
from tangy_tui.text import activity_template as template
from tangy_tui.text.game_template import game_file


def built(draft: Draft, imported: Sequence[ChoiceQuestion] = ()) -> tuple[str, str]:
    """Return the activity's file with the author's welcome and goodbye, and its table.

    Args:
        draft: the answers to all questions.
        imported: the questions of a quiz that were read from a file.
    """
    toml, table = _built(draft, imported)
    said = [draft.said.get(one, "") for one in new.SENTENCES]
    ends = draft.kind in draft.examples.said and any(said)
    return bases.with_ends(toml, *said) if ends else toml, table


def _built(draft: Draft, imported: Sequence[ChoiceQuestion]) -> tuple[str, str]:
    """Return the activity's file, and its table ("": it needs none).

    Args:
        draft: the answers to all questions.
        imported: the questions of a quiz that were read from a file.
    """
    name, title = draft.name, draft.said[new.TITLE]
    comment = words.COMMENT.format(title=title, name=name)
    match draft.kind:
        case new.QUIZ:
            return _quiz(draft, comment, imported)
        case new.TALK:
            item = draft.said[new.ITEM]
            made = template.NewActivity(name, title, item, draft.yes(new.TURNS))
            rows = [(row["text"], row["more"] or words.MORE) for row in draft.rows()]
            table = rows or template.sample_rows(item)
            return template.activity_file(made), bases.written_table(template.COLUMNS, table)
        case new.GAME:
            return game_file(name, title, draft.number(new.WIN_AT)), ""
        case new.CARDS:
            toml = bases.cards_file(
                comment, name, title, claim=draft.said[new.CLAIM],
                shapes=draft.examples.patterns[draft.said[new.PATTERN]],
                numbers=draft.number(new.NUMBERS),
            )  # fmt: skip
            return toml, ""
        case kind:
            toml = bases.table_activity(kind, comment, name, title, draft.number(new.ROUNDS))
            rows_ = [
                [row[one] or (words.STORY if one == "story" else "") for one in draft.fields]
                for row in draft.rows()
            ]
            table_ = bases.written_table(draft.fields, rows_) if rows_ else bases.base_table(kind)
            return toml, table_


def _quiz(draft: Draft, comment: str, imported: Sequence[ChoiceQuestion]) -> tuple[str, str]:
    rows = draft.rows()
    questions = list(imported) or bases.choice_questions(rows)
    teams = listed_answers(draft.said.get(new.TEAMS, ""))
    media = [one for one in (new.PICTURE, new.SOUND) if any(row.get(one) for row in rows)]
    toml = bases.quiz_file(
        comment,
        draft.name,
        draft.said[new.TITLE],
        questions,
        teams=teams,
        points=draft.yes(new.POINTS),
        rounds=draft.number(new.ROUNDS),
        media=media,
        words={
            "summary of teams": words.SUMMARY_OF_TEAMS.format(len(teams)),
            "think it over": words.THINK_IT_OVER,
            "talk it over": words.TALK_IT_OVER,
        },
    )
    if not questions:
        return toml, bases.base_table(new.QUIZ)
    table = questions_table(questions, template.OR, template.HINT)
    if rows:
        hints = [
            row[new.HINT] or (words.HINT_OF_TWO if len(one.options) == 2 else "")
            for row, one in zip(rows, questions, strict=True)
        ]
        columns = {new.HINT: hints, **{one: [row[one] for row in rows] for one in media}}
        table = bases.with_columns(table, columns)
    return toml, table
