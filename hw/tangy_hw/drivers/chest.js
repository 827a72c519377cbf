// Draws the robot's words as large as possible, and acknowledges each picture. A tablet that is not
// paired yet asks for the code on the robot's console.
// For browsers of ten years ago: no framework, no build, nothing newer than EventSource.
(function () {
  "use strict";
  var SILENT = 2000, AGAIN = 500;  // ms: without an event, the link counts as lost; retry delay
  var THANKS = 8000;  // ms: for which the answer to a press is shown
  var LOOK = 1000;  // ms: between two checks of an unpaired tablet
  var page = String(Math.random()).slice(2) + String(Date.now());
  var calls = {}, thanks = "";  // called person by key; answer to a press
  var source = null, heard = Date.now(), waiting = null, dots = 0, picture = null, drawn = 0;

  function get(id) { return document.getElementById(id); }

  function put(id, words) { get(id).textContent = words; }

  // Split "N-40" into letter and number; other text counts as a number.
  function parts(called) {
    var found = /^([^\d\s\-\u2010-\u2013]{1,2})[\s\-\u2010-\u2013]*(\d+)$/.exec(called);
    return found ? [found[1], found[2]] : ["", called];
  }

  // Insert a text word by word, so that it only breaks between words: never within "N-40". After two
  // spaces a new line begins.
  function putWords(id, text) {
    var lines = text.split(/\s{2,}/), words, i, j, span;
    put(id, "");
    for (i = 0; i < lines.length; i += 1) {
      words = lines[i].split(" ");
      if (i) { get(id).appendChild(document.createElement("br")); }
      for (j = 0; j < words.length; j += 1) {
        span = document.createElement("span");
        span.textContent = words[j];
        get(id).appendChild(span);
        get(id).appendChild(document.createTextNode(" "));
      }
    }
  }

  // Enlarge an element to fit its box; it may break between words, never within one.
  function fit(element, box, least, most) {
    var style = window.getComputedStyle(box);
    var wide = box.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    var high = box.clientHeight - parseFloat(style.paddingTop) - parseFloat(style.paddingBottom);
    var others = 0, i, child;
    for (i = 0; i < box.children.length; i += 1) {
      child = box.children[i];
      if (child !== element) { others += child.offsetHeight || 0; }
    }
    while (most - least > 1) {
      var size = Math.floor((least + most) / 2);
      element.style.fontSize = size + "px";
      if (element.scrollWidth <= wide + 1 && element.offsetHeight <= high - others) { least = size; }
      else { most = size; }
    }
    element.style.fontSize = least + "px";
  }

  function draw() {
    var shown = picture, classes = [], called, i, chip, height = window.innerHeight;
    if (document.body.className.indexOf("lost") >= 0) { classes.push("lost"); }
    if (document.body.className.indexOf("unpaired") >= 0) { classes.push("unpaired"); }
    if (document.body.className.indexOf("sleepy") >= 0) { classes.push("sleepy"); }
    if (document.body.className.indexOf("calling") >= 0) { classes.push("calling"); }
    if (shown.number) { classes.push("number"); }
    else if (shown.text) { classes.push("said"); }
    else if (!shown.file) { classes.push("idle"); }
    if (shown.file) { classes.push("pictured"); }
    if (shown.number && shown.text && shown.text !== shown.number) { classes.push("worded"); }
    if (shown.asks) { classes.push("asked"); }
    if (shown.before.length) { classes.push("followed"); }
    called = parts(shown.number);
    put("letter", called[0]);
    put("number", called[1]);
    putWords("text", shown.text);
    put("asked", shown.asks);
    put("before", "");
    for (i = 0; i < shown.before.length && i < 5; i += 1) {
      called = parts(shown.before[i]);
      chip = document.createElement("span");
      chip.appendChild(document.createElement("i")).textContent = called[0];
      chip.appendChild(document.createElement("b")).textContent = called[1];
      get("before").appendChild(chip);
    }
    document.body.className = classes.join(" ");
    get("text").style.fontSize = "";
    get("file").style.height = (shown.text ? 0.72 : 0.97) * get("main").clientHeight + "px";
    if (shown.asks) { fitLine(get("asked"), get("asks"), get("asks").clientHeight * 0.76); }
    if (shown.before.length) { fitLine(get("before"), get("before"), get("before").clientHeight * 0.68); }
    if (shown.number) { fit(get("call"), get("main"), 20, 2000); }
    else if (shown.text) { fit(get("text"), get("main"), 16, height * 0.5); }
  }

  // Set the size of an element, or a smaller one if its row requires it.
  function fitLine(element, row, size) {
    var left;
    for (; size > 10; size *= 0.92) {
      element.style.fontSize = size + "px";
      // A centred row overflows on both sides, and scrollWidth includes only one.
      left = row.firstElementChild.getBoundingClientRect().left;
      if (row.lastElementChild.getBoundingClientRect().right - left <= 0.97 * row.clientWidth) {
        return;
      }
    }
  }

  // Set or clear a state of the page, such as lost or unpaired.
  function mark(word, so) {
    var body = document.body, was = body.className.indexOf(word) >= 0;
    if (so !== was) {
      body.className = so ? body.className + " " + word : body.className.replace(word, "");
      if (picture) { draw(); }
    }
    return so !== was;
  }

  function lost(so) { mark("lost", so); }

  function unpaired(so) {
    if (mark("unpaired", so)) {
      put("wrong", "");
      get("code").value = "";
      if (so) { get("code").focus(); } else { get("code").blur(); }
    }
  }

  // Send a request, and call back with the status, or 0 without an answer.
  function ask(method, path, body, told) {
    var request = new XMLHttpRequest();
    request.open(method, path);
    request.timeout = SILENT;
    request.onload = function () { told(request.status); };
    request.onerror = request.ontimeout = function () { told(0); };
    request.send(body);
  }

  function soon(milliseconds) {
    if (!waiting) { waiting = window.setTimeout(connect, milliseconds); }
  }

  // A sleeping screen shows nothing: keep it awake, or say that the browser cannot.
  function stayAwake() {
    if (document.hidden) { return; }
    if (!navigator.wakeLock) {
      mark("sleepy", true);
      return;
    }
    navigator.wakeLock.request("screen").then(
      function () { mark("sleepy", false); },
      function () { mark("sleepy", true); }
    );
  }

  function pair(viewer) {
    var code = get("code").value.replace(/\D/g, "");
    if (code.length < 8) {
      put("wrong", "The code has eight digits.");
      return;
    }
    ask("POST", "pair", code + (viewer ? " viewer" : ""), function (status) {
      if (status === 204) {
        put("wrong", "");
        connect();
        return;
      }
      put("wrong", status === 403 ? "That is not the code. Please look again." :
        status === 429 ? "Too many wrong codes. Please wait a minute." :
        "The robot does not answer. Please try again.");
      get("code").value = "";
      get("code").focus();
    });
  }

  function answer(number) {
    var request = new XMLHttpRequest();
    request.open("POST", "seen?page=" + page + "&number=" + number);
    request.send();
  }

  // Show a button for each open call, and the answer to a press.
  function drawCalls() {
    var box = get("calls"), key, button;
    box.textContent = "";
    for (key in calls) {
      button = box.appendChild(document.createElement("button"));
      button.textContent = calls[key] + ": I am coming";
      button.onclick = comes(key);
    }
    if (thanks) { box.appendChild(document.createElement("div")).textContent = thanks; }
    if (!mark("calling", box.children.length > 0) && picture) { draw(); }
  }

  // Return the handler for the button of a call.
  function comes(key) {
    return function () {
      this.disabled = true;
      ask("POST", "answer?call=" + encodeURIComponent(key), null, function (status) {
        thanks = status === 204 ? "Thank you." :
          status === 404 ? "Nobody is called any more." :
          "The robot does not answer. Please go to the console.";
        if (status === 204 || status === 404) { delete calls[key]; }
        drawCalls();
        window.setTimeout(function () { thanks = ""; drawCalls(); }, THANKS);
      });
    };
  }

  function hear() {
    heard = Date.now();
    lost(false);
    answer(drawn);
  }

  function show(shown) {
    picture = shown;
    unpaired(false);
    draw();
    drawn = shown.n;
    hear();
  }

  // Load the file of a picture first; skip a file that cannot be loaded.
  function load(shown) {
    var file = get("file");
    file.onload = file.onerror = null;
    if (!shown.file) {
      file.removeAttribute("src");
      show(shown);
      return;
    }
    file.onload = function () { show(shown); };
    file.onerror = function () {
      shown.file = false;
      show(shown);
    };
    file.src = "file?n=" + shown.n;
  }

  function connect() {
    if (waiting) { window.clearTimeout(waiting); waiting = null; }
    if (source) { source.close(); source = null; }
    ask("GET", "paired", null, function (status) {
      if (status === 204) {
        listen();
      } else if (status === 403) {
        heard = Date.now();
        unpaired(true);
        lost(false);
        soon(LOOK);
      } else {
        soon(AGAIN);
      }
    });
  }

  function listen() {
    if (source) { source.close(); }
    source = new EventSource("events?page=" + page);
    drawn = 0;  // another robot has its own numbers
    source.addEventListener("show", function (event) {
      load(JSON.parse(event.data));
    });
    source.addEventListener("calls", function (event) {
      calls = JSON.parse(event.data);
      drawCalls();
    });
    source.addEventListener("alive", hear);
    source.onerror = function () {
      this.close();
      soon(AGAIN);
    };
  }

  window.setInterval(function () {
    var silent = Date.now() - heard;
    if (silent > SILENT) {
      lost(true);
      dots = (dots + 1) % 4;
      put("dots", "...".slice(0, dots));
      if (silent % (4 * SILENT) < 500) { soon(AGAIN); }
    }
  }, 500);
  get("pair").addEventListener("submit", function (event) {
    event.preventDefault();
    pair(false);
  });
  get("viewer").addEventListener("click", function () { pair(true); });
  document.addEventListener("visibilitychange", stayAwake);
  stayAwake();
  window.addEventListener("resize", function () { if (picture) { draw(); } });
  connect();
}());
