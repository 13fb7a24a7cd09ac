#!/usr/bin/env python3
"""The pages as a reader has them: links that lead somewhere, pictures that are there, no raw markup; in headless Chromium,
where it is installed, nothing wider than the window at 1280 and 400 pixels, no code clipped, and a search that finds.

usage: pages_test.py HTML [--pictures DIRECTORY PAGE...]

--pictures keeps pictures of these pages at both widths, to be looked at.
"""
import argparse
import functools
import html.parser
import http.server
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import urllib.parse

WIDTHS = (1280, 400)
SECONDS = 240
RAW = re.compile(r":(?:c|py|doc|ref|fortran)(?::\w+)?:`|```|\{toctree\}|<!--|\*\*\w|\w\*\*|\\[*`_|]|\|---|\]\(\.\.?/|\$\$|\\frac|\\mathbf|"
                 r"\.\. (?:code|list|c:|toc)")


class Page(html.parser.HTMLParser):
    """Links, pictures, anchors and the text of a page, code left out."""

    def __init__(self, text):
        super().__init__()
        self.links, self.pictures, self.ids, self.words, self.inside, self.title = [], [], set(), [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        if "id" in values:
            self.ids.add(values["id"])
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        if tag == "img":
            self.pictures.append(values.get("src", ""))
        if tag in ("pre", "code", "script", "style", "math", "svg"):
            self.inside.append(tag)

    def handle_endtag(self, tag):
        if self.inside and self.inside[-1] == tag:
            self.inside.pop()

    def handle_data(self, data):
        if not self.inside:
            self.words.append(data)


def read_pages(directory):
    found = {}
    for root, _, names in os.walk(directory):
        for name in names:
            if name.endswith(".html"):
                path = os.path.join(root, name)
                with open(path, encoding="utf-8") as source:
                    found[os.path.relpath(path, directory)] = Page(source.read())
    return found


def faults_of(directory, pages):
    faults = []
    for name, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(name), urllib.parse.unquote(parts.path))) if parts.path else name
            if not os.path.exists(os.path.join(directory, target)):
                faults.append("%s: the link %s leads nowhere" % (name, link))
            elif parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].ids:
                faults.append("%s: there is no %s" % (name, link))
        for picture in page.pictures:
            if "://" in picture or not os.path.exists(os.path.join(directory, os.path.dirname(name), picture)):
                faults.append("%s: the picture %s is not there" % (name, picture))
        for raw in RAW.finditer(" ".join(page.words)):
            text = " ".join(page.words)
            faults.append("%s: raw markup: %s" % (name, text[max(0, raw.start() - 40):raw.end() + 40].replace("\n", " ")))
    return faults


CHECK = """<!doctype html><body style="margin:0"><script>
const pages = %s, widths = %s, faults = [];
const wait = seconds => new Promise(done => setTimeout(done, 1000 * seconds));
async function open(page, width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = `border:0;height:900px;width:${width}px`;
  document.body.append(frame);
  await new Promise(done => { frame.onload = done; frame.src = "/" + page; });
  return frame;
}
async function look(page, width) {
  const frame = await open(page, width), root = frame.contentDocument.documentElement;
  if (root.scrollWidth > width + 1) {
    const wide = [...root.querySelectorAll("article *")].find(one => one.getBoundingClientRect().right > width + 1);
    faults.push(`${page}: ${root.scrollWidth} pixels in a window of ${width}: ${wide ? wide.outerHTML.slice(0, 120) : ""}`);
  }
  for (const code of root.querySelectorAll("pre"))
    if (code.scrollWidth > code.clientWidth + 1) faults.push(`${page}: clipped code at ${width}: ${code.textContent.slice(0, 60)}`);
  for (const picture of root.querySelectorAll("img"))
    if (picture.loading != "lazy" && !(picture.complete && picture.naturalWidth)) faults.push(`${page}: no picture ${picture.src}`);
  frame.remove();
}
async function search() {
  const frame = await open("search.html?q=gravity", 1280);
  for (let k = 0; k < 100 && !frame.contentDocument.querySelector("#search-results li a"); k++) await wait(.1);
  if (!frame.contentDocument.querySelector("#search-results li a")) faults.push("the search finds nothing");
}
(async () => {
  try {
    for (const width of widths) for (const page of pages) await look(page, width);
    await search();
  } catch (error) { faults.push(String(error)); }
  await fetch("/faults", {method: "POST", body: JSON.stringify(faults)});
})();
</script></body>"""


class Server(http.server.SimpleHTTPRequestHandler):
    pages, faults, done = "", None, threading.Event()

    def log_message(self, *_):
        pass

    def do_GET(self):
        if self.path != "/check":
            return super().do_GET()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.end_headers()
        self.wfile.write(Server.pages.encode())

    def do_POST(self):
        Server.faults = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.send_response(204)
        self.end_headers()
        Server.done.set()


def chromium(browser, work, *arguments):
    return [browser, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-dev-shm-usage",
            "--disable-background-networking", "--user-data-dir=" + os.path.join(work, "profile"), *arguments]


def looked_at(browser, directory, pages):
    """What the browser finds wrong."""
    Server.pages = CHECK % (json.dumps(sorted(pages)), json.dumps(WIDTHS))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Server, directory=directory))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
        process = subprocess.Popen(chromium(browser, work, "--remote-debugging-port=0", "http://127.0.0.1:%d/check" % server.server_port),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        finished = Server.done.wait(SECONDS)
        process.terminate()
        process.wait(30)
    server.shutdown()
    return Server.faults if finished else ["the browser has not looked at all pages within %d s" % SECONDS]


def keep_pictures(browser, directory, to, pages):
    os.makedirs(to, exist_ok=True)
    for page in pages:
        for width in WIDTHS:
            with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as work:
                name = os.path.join(to, "%s-%d.png" % (page.replace("/", "_").replace(".html", ""), width))
                subprocess.run(chromium(browser, work, "--window-size=%d,2400" % width, "--screenshot=" + name,
                                        "file://" + os.path.join(directory, page)), check=True, stderr=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("html", type=os.path.abspath)
    parser.add_argument("--pictures", nargs="+", default=[])
    arguments = parser.parse_args()
    if not os.path.isdir(arguments.html):
        print("skipped: there are no pages")
        return 77
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    if arguments.pictures:
        keep_pictures(browser, arguments.html, os.path.abspath(arguments.pictures[0]), arguments.pictures[1:])
        return 0
    pages = read_pages(arguments.html)
    faults = faults_of(arguments.html, pages)
    if browser:
        faults += looked_at(browser, arguments.html, pages)
    print("\n".join(faults[:100]))
    print("%d pages, %d faults%s" % (len(pages), len(faults), "" if browser else "; chromium is not installed: not looked at"))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
