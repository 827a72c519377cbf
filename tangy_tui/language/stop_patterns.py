"""Regular expressions of sentences that stop the robot or the game, composed of small ones.

They match clauses of lower-case words with single spaces, without apostrophes, and with numbers as
digits. A sentence consists of calls and requests ("please", "can you", "i want it to"), a verb of
stopping, its object, its manner, and a further thought. `game` stands for the words of the
activity's title.
"""

from __future__ import annotations

import re
from functools import cache


def _any(*ways: str) -> str:
    """Return a pattern that matches any of these; an item may itself be alternatives."""
    return f"(?:{'|'.join(ways)})"


# ------------------------------------------------------------------------------ who or what stops

DETERMINER = (
    "all of (?:the|this|that)|all(?: the| this| your)?|any|the|this|that|your|my|our|its|these"
    "|those"
)
PASSION = (
    "whole|entire|bloody|stupid|damn(?:ed)?|darn|silly|crazy|mad|blasted|poor|big|little|horrible"
    "|left|right|other|front|rear|old|dear|good|lovely|nasty|wretched"
)
NO_ADJECTIVE = (
    "of|on|in|at|to|by|for|from|with|and|or|near|behind|beside|into|like|as|than|not|is|are|was"
    "|a|an|the|that|this|my|your|his|her|our|their|who|which|you|i|we|he|she|they|it|him|them"
    "|coffee|tea|washing|sewing|vending|answering|ticket|slot|fax|ice|cash|copy|knitting|bread"
    "|weighing|fruit|time|drinks?|milling|rowing|exercise|x ray|ultrasound|infusion|dialysis"
)
"""Words that never mean the robot, including other machines."""
BODY = "robots?|bot|machine|machinery|thing|tangy|device|contraption|system"
LIMBS = "base|wheels?|motors?|engines?|drives?|arms?|hands?|head|movements?|motions?|moving|driving"
PLAYS = "games?|rounds?|programme|activity|session|exercise|program|playing|play|demo|test|trial"
DOINGS = "lot|nonsense|madness|noise|talking|experiment|simulation|action"
_CALLED = "robots?|bot|machine|tangy|contraption"
ROBOT = (
    f"(?:(?:(?:{DETERMINER}) )?(?:(?:{PASSION}|game) )*(?:{BODY})"
    rf"|(?:{DETERMINER}) (?:(?!(?:{NO_ADJECTIVE})\b)\w+ ){{1,3}}(?:{_CALLED}))"
)
GAME = f"(?:{DETERMINER}) (?:(?:{PASSION}|game) )*(?:{LIMBS}|{PLAYS}|{DOINGS})|game"
_IS = f"(?:(?:you|it|he|she|they|{ROBOT}) (?:are|is)|youre|its|hes|shes|theyre)"
_DOING = f"(?:what|whatever) (?:it is )?{_IS} (?:doing|up to)"
THINGS = _any(
    "all of (?:it|this|that)|everything|everybody|everyone|yourself|itself|himself|herself|all",
    f"doing (?:that|this|it|everything|anything)|(?:doing )?{_DOING}|it all|it|that|this|these",
)
ITSELF = _any(ROBOT, GAME, THINGS)
SOMEBODY = "him|her|them"

# ------------------------------------------------------------------------------ manner and reason

SAKE = r"for (?:\w+ )?\w+ sake|in (?:gods|heavens) name|in the name of (?:god|heaven)"
NAMED = (
    "tangy|robot|(?:my )?dear|love|young (?:man|lady)|mister|sir|buddy|mate|pal|darling"
    "|sweetheart|everybody|everyone|you"
)
_MOMENT = "moment|second|sec|minute|instant|while|bit"
HOW = _any(
    "now|please|immediately|instantly|here|there|already|altogether|completely|dead|quick|quickly",
    "fast|then|today|yet|stop|halt|no|oh|okay|ok|thanks|thank you|again|at last|finally|for good",
    "at once|at this point|straight ?away|right (?:now|away|here|there|off)|just|still|emergency",
    "(?:right |exactly |just )?where(?:ver)? (?:you are|youre|it is|it stands)",
    f"(?:right )?this (?:very )?(?:{_MOMENT})|for (?:just )?(?:a|1|this) (?:{_MOMENT})",
    f"a (?:{_MOMENT})|for (?:now|today|everyone|everybody|me|us)|(?:will|would|can|could|wont) you",
    "if you(?:d| would) be so kind|as quick as you can",
    "do you hear(?: me)?|i (?:said|say|tell you|beg you|mean it)|this is an emergency",
    "its an emergency|nothing else|at all costs|or else|if you can|as (?:fast|soon) as you can",
    "with immediate effect|without delay|on the spot|absolutely|right in front of (?:me|us|her)",
    f"(?:dead )?in (?:your|its) tracks|somebody|someone|{NAMED}|{SAKE}",
)
_FINITE = "is|are|has|have|had|was|fell|hit|cant|cannot|wont|will|needs?|hurts?|does|do|did"
_OTHERS = (
    r"(?!\w+ing\b|who|what|which|where|when|that\b|to\b|from\b|at\b|in\b|by\b|me\b|us\b"
    r"|services?\b|room\b|ward\b|exits?\b|doctors?\b|signs?\b|lights?\b)"
)
NEXT = _any(
    "(?:before|or|because|cause|cos|until|till|and|but|there|theres|i|im|youre|hes|shes|theyre) .*",
    "(?:its|thats|somebody|someone|something|watch|look|mind|careful|wait|let|help|dont|not) .*",
    r"(?:you|it|he|she|we|they) (?!2|3|all|lot)\w+(?: .*)?",
    rf"(?:that|this) (?:{_FINITE})\b.*",
    rf"{_OTHERS}(?:\w+ ){{1,3}}(?:{_FINITE})\b.*",
)
"""A further thought: why it should stop, or what to do then."""
AFTER = f"(?: {HOW}){{0,6}}(?: {NEXT})?"

# ------------------------------------------------------------------------- what the robot is doing

_DRIVES = (
    "moving|driving|rolling|turning|spinning|rotating|reversing|backing|going|coming|running"
    "|walking|approaching|advancing|proceeding|wandering|circling|rushing|speeding|accelerating"
    "|steering|charging|crashing|colliding|pulling|dragging|grabbing|waving|swinging|shaking"
    "|touching|working|operating|acting|continuing|wheeling|swerving|veering|lurching|jerking"
    "|zooming|wobbling|sliding|tilting|beeping"
)
_HARMS = (
    "hurting|hitting|pushing|crushing|squeezing|squashing|ramming|trapping|pinning|blocking"
    "|bumping|chasing|following|knocking"
)
_HITS = "banging|bashing|bumping|knocking|running|scraping|slamming|smashing|crashing|driving"
_TAKES = "grabbing|grasping|gripping|clutching|twisting|catching"
_TAKEN = (
    "arms?|hands?|wrists?|fingers?|shoulders?|sleeves?|clothes|jacket|coat|skirt|dress|foot|feet"
    "|chair|wheelchair|walker|frame|stick"
)
_MINE = "my|our|her|his|their"
_SPEAKS = (
    "playing|calling(?: out)?|drawing|talking|speaking|announcing|celebrating|doing|counting"
    "|reading"
)
PEOPLE_DO = (
    "arguing|bickering|biting|boasting|bothering|bullying|chatting|cheating|chewing|complaining"
    "|coughing|crying|cursing|daydreaming|dreaming|drinking|eating|fibbing|fidgeting|fighting"
    "|flirting|frowning|fussing|giggling|gossiping|grinning|grumbling|guessing|hoping|joking"
    "|kidding|laughing|lying|moaning|mumbling|nagging|picking|pouting|pretending|quarrelling"
    "|scratching|shouting|showing|sighing|smiling|smoking|sneezing|snoring|sobbing|squabbling"
    "|staring|stealing|sulking|swearing|teasing|thinking|whining|whispering|whistling|winking"
    "|wondering|worrying|yawning|yelling"
)
"""Actions that only people do: the sentence is not about the robot, even without a name."""
_WHOM = "me|us|him|her|them|you|it|that|this|people|everybody|everyone|anybody|anyone|somebody"
_WHERE = (
    r"about(?! (?:it|that|this|him|her|them|me|us)\b)|"
    "forwards?|backwards?|back|up|around|round|away|off|on|in|out|over|ahead|left|right|sideways"
    "|closer|nearer|further|faster|so (?:fast|quickly|close|near|much)|(?:this|that) way"
    "|in circles|in (?:my|our|her|his|the) way|to the (?:left|right|front|back|table)"
)
_TOWARDS = "(?:towards?|at|into|against|over|onto|near|behind|after|past|around|round)"
_PLACE = rf"{_TOWARDS} (?:\w+ )?\w+|to (?:{_WHOM}|user \w+|seat \w+|player \w+)"
_OF_PLAY = f"to (?:{_WHOM})|(?:the |any )?(?:more )?numbers?|jokes|{ROBOT}|{GAME}"
_MOVING = _any(
    f"(?:{_DRIVES}|{_HARMS})(?: (?:{_WHERE}|{_PLACE}|{_WHOM}|{ROBOT}|{GAME})){{0,4}}",
    rf"(?:{_HARMS}) (?:(?:the|my|our|a) )?(?!your)\w+",
    rf"(?:{_HITS}) (?:into|against) (?:(?:the|a|{_MINE}) )?\w+",
    rf"(?:{_TAKES}) (?:on ?to )?(?:{_MINE}) (?:\w+ )?(?:{_TAKEN})",
    f"(?:getting|being) (?:so |too )?(?:closer|nearer|close|near)(?: to (?:{_WHOM}))?",
    f"(?:getting|being) in (?:{_MINE}) way",
    f"(?:{_SPEAKS})(?: (?:{_OF_PLAY}))?",
)
_OTHERWISE = rf"(?!(?:{PEOPLE_DO})\b)\w+ing"

# ----------------------------------------------------------------------------------- calls and
# requests

CALL = _any(
    "no|nope|oh|ah|aah|ow|ouch|ooh|hey|hi|hello|okay|ok|alright|all right|right|well|so|and|but",
    "just|now|wait|whoa|woah|please|quick|quickly|fast|hurry(?: up)?|help(?: me| us| her| him)?",
    "hold on|hang on|listen|look(?: out)?|watch(?: out| it)?|mind out|careful|be careful|sorry",
    "excuse me|danger|(?:im |i am )?(?:so |very |terribly |really )?sorry",
    "(?:my |oh )?(?:god|gosh|goodness|lord|dear)|jesus|christ|damn|damn it|dammit|hell|come on",
    f"enough|that(?: i)?s (?:enough|it)|(?:i|we) (?:said|say|repeat|mean)|{NAMED}|{SAKE}|nurse",
    "somebody|someone|anybody|anyone|guys|immediately|at once|first|really|not another \\w+|ha",
    "emergency|(?:this is|its) an emergency|then|also|yes|do|stop|halt|end (?:it|this)|kindly",
    "(?:go|get|keep|stay|move) (?:away|off|back)|back off|leave (?:me|us|her|him|them|it) alone",
    "(?:i am|im|we are|were) begging you|i beg (?:of )?you",
    "everything|cancel",
)
_MUST = (
    "must|have to|has to|have got to|has got to|got to|gotta|needs? to|should|ought to|had better"
    "|better|d better"
)
_YOU = f"you|we|i|{ROBOT}|somebody|someone|anybody|anyone"
_WISH = "want|wants|wanted|need|needs|would like|order|command|beg|ask|tell|am telling"
_WISHED = "asked|told|ordered|commanded|begged"
_ASKING = "asking|telling|begging|ordering|commanding|imploring|warning"
_CAUSE = "make|get|have|let|tell|ask|order|force|command|help|bring"
_NOBODY = "dont|didnt|doesnt|never|not|nobody"
ASK = _any(
    "(?:would you )?be so (?:kind|good) (?:as to|and)|may i (?:please )?ask you to",
    rf"(?:make|tell|get|ask) (?:{SOMEBODY})(?: to)?(?= (?:stop|quit) (?:{_DRIVES})\b)",
    f"(?:{_YOU}|youd|wed|id|it|this|that|everything|{GAME}) (?:just |really |all )*(?:{_MUST})",
    "you (?:can|could|will|would|may|might)",
    "if you (?:can|could|would)(?: (?:please|kindly|just|now))*",
    f"(?:can|could|will|would|shall|should|may|might|cant|couldnt|wont|wouldnt|shouldnt)"
    f" (?:{_YOU}|it)(?: (?:please|kindly|just|now|possibly|perhaps))*",
    f"(?:im|i am|were|we are) (?:just |really |now )*(?:{_ASKING}) (?:{ITSELF}|you) to",
    f"why (?:dont|cant|wont|wouldnt|couldnt) (?:{_YOU})",
    rf"(?!{_NOBODY})\w+ (?:just |really |now )*(?:{_WISH}) (?:{ITSELF}|you) to",
    f"(?:i|we) (?:just |already )*(?:{_WISHED}) (?:{ITSELF}|you) to",
    "(?:i|we) (?:really )?(?:think|guess|suppose|believe|suggest)(?: that)?",
    f"(?:(?:i|we)(?:d like| would like|d want)|id like|wed like) (?:(?:{ITSELF}|you) )?to",
    "(?:i|we) (?:just |really )*(?:want|need|wish) to|im going to|lets|let us",
    f"(?:{_CAUSE}) (?:{ROBOT}|{GAME}|it|this|that|everything|yourself)(?: to)?",
    "(?:(?:it is|its) (?:high )?)?time to|(?:how|where|a way) (?:do|can|could|would) \\w+",
    "(?:do|does) (?!it\\b|he\\b|she\\b)\\w+ know how to|how to|try to|(?:go|be) and",
    "(?:tell|show) me how to",
    "how does 1|(?:press|push|pull|do) to|is there a way to|i (?:do not|dont) know how to",
)

# -------------------------------------------------------------------------------- the whole
# sentence

STOP = "stop|halt|cease|freeze|abort|brake"
_DONE = f"(?:(?:it|that|{ROBOT}|{GAME}) (?:from )?)?{_MOVING}"
_AIM = _any(
    f"(?:{ITSELF}|{SOMEBODY}|{_DONE}){AFTER}",
    f"{_OTHERWISE}(?: {HOW}){{0,6}}",
    f"{ROBOT} .*",
)
_WHAT = f"(?:(?: {HOW}){{0,3}} {_AIM}|{AFTER})"
_OWN = r"(?:me|us|him|her|them|(?:my|our|his|her|their|your) \w+)"
_FROM = f"from {_OWN}"
_STILL = _any(
    "(?:stand|hold|keep|stay|remain) (?:absolutely |perfectly |completely |very )?(?:still|put)",
    "stay (?:right |exactly )?(?:where (?:you are|youre)|there|put)|hold it|stand down",
    "(?:do not|dont|dont you|dont you dare) (?:you )?move(?: any ?more| any further| a muscle)?",
    "(?:do not|dont) move another (?:inch|step|metre|centimetre)|full stop (?:now|tangy|robot)",
    "(?:do not|dont) (?:come|go|move|drive) (?:any )?(?:closer|nearer|further|on|anywhere)",
    "(?:do not|dont) (?:come|get|go|move|drive) (?:so |too )?(?:near|close)"
    "(?: to)?(?: (?:me|us|him|her|them|people|anybody|anyone))?",
    "(?:do not|dont) (?:drive|do anything)|do nothing|go no further|no (?:further|closer)",
    "not another (?:inch|step|move|metre|centimetre)|nobody move|e ?stop|enough",
    "(?:(?:this is|its) an )?emergency",
    "that(?: i)?s enough|cut it out|knock it off|shut ?down|power (?:off|down)|switch off",
    "come to a (?:complete |full )?(?:stop|halt|standstill)|hit the brakes?|brakes?",
    "(?:whoa|woah)(?: there)?(?: (?:boy|girl|nelly))?|(?:easy|steady) (?:there|now|boy|on)",
    f"(?:stay|keep|stand|move) (?:back|away|off)(?: {_FROM})?|back (?:off|away)(?: {_FROM})?",
    f"(?:get|take|move|keep) (?:{ROBOT} (?:away|off)(?: {_FROM}| {_OWN})?"
    f"|(?:it|this|that) (?:away|off) (?:{_FROM}|{_OWN}))",
    "(?:that|this)(?: i)?s (?:quite |more than )?(?:far|close|near|quite) enough",
    "(?:tangy|robot) wait|wait (?:there|tangy|robot)|pause (?:it|there)|(?:far|close|near) enough",
    "game over|unplug it|(?:hit|press|push) (?:the|that) (?:big )?red button",
)
_OFF = "turn|switch|shut|power"
_CANCEL = "cancel|interrupt|suspend|pause|abandon|break off|call off|quit|terminate|discontinue"
_PRESS = "hit|press|push|use|pull|activate|trigger|find|get|reach|where is|wheres"
_SWITCHED = _any(
    f"(?:{_OFF}) {ITSELF} (?:off|down)|(?:{_CANCEL}|hold) (?:{ROBOT}|{GAME})|quit {_MOVING}",
    f"(?:(?:{_OFF}) (?:off|down)|quit|put (?:a stop|an end) to|call a halt to) {ITSELF}",
    f"bring {ITSELF} to a (?:complete |full )?(?:stop|halt|standstill)|stop button",
    "(?:cut|kill|disable|disengage) (?:(?:the|its|your|all) )*(?:power|engines?|motors?|drives?"
    "|wheels?)|put the brakes on|slam on the brakes",
    f"(?:{_PRESS}) (?:(?:the|that|its) )?(?:red |big |emergency )*(?:e ?)?"
    "(?:stop|brake|emergency button)(?: button| switch)?",
    "(?:safety|emergency) (?:stop|halt|brakes?|off|shutdown)",
    "(?:do|make|(?:(?:i|we) )?need) (?:an|the) emergency (?:stop|halt|shutdown)",
)
_FAILS = "wont|doesnt|isnt|does not|will not|is not|cant|didnt"
_COMPLAINT = (
    f"(?:why )?(?:(?:{_FAILS}) (?:it|{ROBOT})|(?:it|{ROBOT}|its) (?:just )?(?:{_FAILS}|not))"
    " (?:stop|stopping|halt)(?: (?:moving|driving|rolling|turning|going))?"
)
_STOPPED = _any(
    *(_STILL, _SWITCHED, _COMPLAINT),
    f"(?:{_CAUSE}) (?:{SOMEBODY})(?: to)? (?:please )?(?:{STOP})",
    f"(?:(?:i|we) )?(?:want|need|have|get) (?:{ITSELF}|you) stopped",
    f"(?:{ROBOT}|{GAME}|it|this|that) (?:{_MUST}) be stopped",
    f"(?:can|could) (?:{ROBOT}|{GAME}|it|this|that) be (?:stopped|halted|paused|switched off)",
    f"(?:i|we|she|he|they) (?:cant|cannot|can not|couldnt) (?:{STOP}) (?:{ROBOT})",
)
_SENTENCE = _any(
    f"(?:{STOP}|(?:(?:would|do) you mind|how about) stopping){_WHAT}",
    f"{_STOPPED}{AFTER}",
    f"stop(?:s|ped) (?:{ROBOT}|it|at once|right (?:now|away|there))",  # as it may be misheard
)


@cache
def sentence() -> re.Pattern[str]:
    """Return the pattern of the stop itself, after any calls and requests.

    It takes a tenth of a second to compile, so it is compiled on first use.
    """
    return re.compile(_SENTENCE)


@cache
def command() -> re.Pattern[str]:
    """Return the pattern of a stop that also counts after other words in the same sentence."""
    told = f"(?:{STOP}|quit) (?:(?:{ROBOT}|{GAME}|it)|{_MOVING})"
    return re.compile(f"{_any(told, _STILL, _SWITCHED)}(?: {HOW}){{0,6}}")


@cache
def before() -> tuple[re.Pattern[str], ...]:
    """Return the patterns that may precede the stop, any number of times."""
    return tuple(re.compile(f"{pattern} ") for pattern in (CALL, ASK))


@cache
def own_words() -> frozenset[str]:
    """Return every word in the patterns."""
    return frozenset(re.findall("[a-z]+", "|".join((CALL, ASK, _SENTENCE))))


# ------------------------------------------------------------- a stop at the end of other words

ASKS_FIRST = re.compile(
    r"(?:where|when|what|who|which|how|why|does|do|did|will|would|is|are|was|has|have|can|could|if)"
    r"\b"
)


@cache
def alarm() -> re.Pattern[str]:
    """Return the pattern of an alarmed exclamation."""
    return re.compile(
        rf"(?:{CALL}|youre|you are|mind|watch|its|hes|shes|theyre|too|{ROBOT})\b.*"
        r"|.*\b(?:is|are|has|have|fell|hit|hurts|im|theres)\b.*"
    )


@cache
def cry() -> re.Pattern[str]:
    """Return the pattern of a cry to stop, with the words `before` it and its object `what`."""
    what = f" (?:{ROBOT}|{GAME}|it)"
    return re.compile(rf"(?P<before>.+) (?:{STOP})(?P<what>{what})?(?: {HOW}){{0,6}}")


CRIES = frozenset(STOP.split("|"))
NO_CRY_BEFORE = frozenset(
    (
        *("by", "in", "over", "off", "up", "for", "to", "at", "with", "from", "near", "beside"),
        *("next", "sign", "light", "watch", "press", "gap", "valve", *PEOPLE_DO.split("|")),
    )
)
"""Words after a verb of stopping that show that it is no cry."""
ENDS_A_THOUGHT = frozenset(("this", "that", "and"))
"""Words before the verb of stopping that end or join a clause."""
FORBIDS = re.compile(
    r"\b(?:not|never|nobody|(?:do|does|did|wo|would|could|should|need|must)nt)\b|.* to \w+ and$"
)
NO_CRY_AFTER = frozenset(
    (
        *("to", "dont", "not", "never", "cant", "cannot", "couldnt", "wont", "wouldnt", "shouldnt"),
        *("doesnt", "didnt", "isnt", "neednt", "mustnt", "will", "would", "can", "could", "shall"),
        *("should", "may", "might", "must", "do", "does", "did", "i", "you", "he", "she", "we"),
        *("they", "who", "which", "that", "a", "an", "the", "this", "my", "your", "our", "his"),
        *("their", "its", "bus", "tram", "train", "coach", "truck", "taxi", "rest", "pit", "full"),
        *("non", "1", "door", "tab", "whistle", "next", "last", "first", "second", "final"),
        *("short", "long", "every", "each", "any", "no", "some", "another", "at", "of", "in", "by"),
        *("with", "for", "from", "or", "than", "ever", "only", "always", "often", "sometimes"),
        *("says", "say", "said", "sign", "word", "called", "and", "where", "when", "how", "why"),
        *("if", "people", "buses", "trains", "nonstop", "without", "until", "nearly", "almost"),
    )
)
"""Words after which stopping is a noun, or the action of somebody."""
NO_COMMAND_AFTER = NO_CRY_AFTER | set(f"{_FINITE}|be|been|were|get|got|let|just".split("|"))
"""Words after which the rest belongs to their clause."""
REPORTS_OR_ASKS = re.compile(
    r"(?:where|when|what|who|which|how|why|does|do|did|is|are|was|has|have|he|she|they|my|his|her)"
    r"\b"
)
"""Beginnings of sentences that report or ask about stopping."""
